#include "sss/medium/radial_envelope.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sss {
namespace {

constexpr double kStepsPerOctave = 16;
constexpr int kSteps = 480;  // 30 octaves: 1e-5 to 1e4 scales
/// The extrema between grid points, and the error of the difference quotients, both under 2 %.
constexpr double kSafety = 1.05;

/// |f'|, |f''|, |f'''| at r by central differences of 6th, 6th and 4th order.
std::array<double, 3> derivatives(const std::function<double(double)>& f, double r) {
    const double probe = 0.01 * r;
    const double middle = f(r);
    const double slope = middle > 0 ? std::abs(f(r + probe) - middle) / (middle * probe) : 0;
    const double h = 0.1 / (4 / r + slope);
    const double p1 = f(r + h), m1 = f(r - h);
    const double p2 = f(r + 2 * h), m2 = f(r - 2 * h);
    const double p3 = f(r + 3 * h), m3 = f(r - 3 * h);
    const double first = (45 * (p1 - m1) - 9 * (p2 - m2) + (p3 - m3)) / (60 * h);
    const double second =
        (270 * (p1 + m1) - 27 * (p2 + m2) + 2 * (p3 + m3) - 490 * middle) / (180 * h * h);
    const double third = (-13 * (p1 - m1) + 8 * (p2 - m2) - (p3 - m3)) / (8 * h * h * h);
    return {std::abs(first), std::abs(second), std::abs(third)};
}

}  // namespace

RadialEnvelope::RadialEnvelope(const std::function<double(double)>& function, double scale,
                               bool singularAtZero)
    : firstRadius_(1e-5 * scale), singularAtZero_(singularAtZero) {
    for (auto& bounds : bounds_) bounds.assign(kSteps, 0.0);
    std::array<double, 3> running{};
    for (int i = kSteps - 1; i >= 0; --i) {
        const double r = firstRadius_ * std::exp2(i / kStepsPerOctave);
        const std::array<double, 3> here = derivatives(function, r);
        for (std::size_t k = 0; k < 3; ++k) {
            running[k] = std::max(running[k], here[k]);
            bounds_[k][static_cast<std::size_t>(i)] = kSafety * running[k];
        }
    }
}

double RadialEnvelope::bound(int order, double r) const {
    const auto k = static_cast<std::size_t>(order - 1);
    const double position = std::log2(r / firstRadius_) * kStepsPerOctave;
    if (position >= 0) {
        return bounds_[k][static_cast<std::size_t>(std::min(position, kSteps - 1.0))];
    }
    if (!singularAtZero_) return bounds_[k][0];
    if (r <= 0) return std::numeric_limits<double>::infinity();
    return bounds_[k][0] * std::pow(firstRadius_ / r, order + 1);
}

}  // namespace sss
