#include "sss/shape/disk_mean.h"

#include <cmath>

namespace sss {

DRgb diskMeanOfGreen(const DRgb& screening, double radiusMm, double asideMm, double depthMm) {
    constexpr int kSteps = 12;
    DRgb sum{0};
    for (int i = 0; i < kSteps; ++i) {
        const double angle = 2 * kPi * (i + 0.5) / kSteps;
        const double c = std::cos(angle), s = std::sin(angle);
        // From the foot to the rim; the line between them turns by `turn` per angle at the centre.
        const double x = radiusMm * c - asideMm, y = radiusMm * s, squared = x * x + y * y;
        if (!(squared > 0)) continue;
        const double turn = radiusMm * (x * c + y * s) / squared;
        // Integral of exp(-k r) rho / r over the distance rho from the foot, r^2 = rho^2 + depth^2,
        // times exp(k depth).
        const double further = squared / (std::sqrt(squared + depthMm * depthMm) + depthMm);
        for (int channel = 0; channel < 3; ++channel) {
            const double k = screening[channel];
            sum[channel] += turn * (k > 0 ? -std::expm1(-k * further) / k : further);
        }
    }
    return sum * glm::exp(-screening * depthMm) / (2 * kSteps * kPi * radiusMm * radiusMm);
}

}  // namespace sss
