#include "sss/integrate/probe_radius.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sss {
namespace {

constexpr std::size_t kCells = 512;
// Below this share of a mean free path profiles are flat, or go like 1/r.
constexpr double kFlat = 1e-3;

double shortestScale(const std::array<const Profile*, 3>& profiles) {
    return std::min({profiles[0]->scaleMm(), profiles[1]->scaleMm(), profiles[2]->scaleMm()});
}

// Masses of the cells whose edges are `radii`.
std::vector<double> masses(const std::array<const Profile*, 3>& profiles,
                           std::span<const double> radii) {
    std::vector<double> sums(radii.size() - 1, 0.0);
    for (const Profile* profile : profiles) {
        const double total = profile->tail(0) - profile->tail(radii.back());
        if (!(total > 0)) continue;
        double before = profile->tail(0);
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const double after = profile->tail(radii[i + 1]);
            sums[i] += std::max(before - after, 0.0) / total;
            before = after;
        }
    }
    return sums;
}

}  // namespace

ProbeRadius::ProbeRadius(const std::array<const Profile*, 3>& profiles, double reachMm)
    : scale_(static_cast<float>(kFlat * std::min(shortestScale(profiles), reachMm))),
      exponent_(static_cast<float>(std::log1p(reachMm / static_cast<double>(scale_)))),
      cells_([&] {
          std::vector<double> radii(kCells + 1);
          for (std::size_t i = 0; i <= kCells; ++i)
              radii[i] = radiusAt(static_cast<double>(i) / kCells);
          return PiecewiseConstant1D(masses(profiles, radii));
      }()) {}

double ProbeRadius::radiusAt(double x) const {
    return static_cast<double>(scale_) * std::expm1(static_cast<double>(exponent_) * x);
}

float ProbeRadius::sample(float u) const {
    return scale_ * std::expm1(exponent_ * cells_.sample(u).x);
}

float ProbeRadius::density(float rMm) const {
    const float x = std::log1p(rMm / scale_) / exponent_;
    if (!(x < 1.0f)) return 0;
    return cells_.pdf(x) / (2 * kPiF * rMm * exponent_ * (rMm + scale_));
}

}  // namespace sss
