#include "sss/cloud/regularised_profile.h"

#include "sss/base/vec.h"
#include "sss/optics/gauss_legendre.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sss {
namespace {

// Smooth cutoff: 1 at 0, 0 from x = 1 on, two continuous derivatives.
double fade(double x) {
    if (x >= 1.0) return 0.0;
    return 1.0 - x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
}

// Angle of the circle of radius s around a point that lies inside a disk of radius a at distance r.
double arcInsideDisk(double s, double r, double a) {
    if (s <= a - r) return 2.0 * kPi;
    if (s >= a + r || s <= r - a) return 0.0;
    return 2.0 * std::acos(std::clamp((r * r + s * s - a * a) / (2.0 * r * s), -1.0, 1.0));
}

// In cell radii: where the average begins to give way to the profile itself, and where it has.
constexpr double kBlendFrom = 2.5, kBlendTo = 5.0;

}  // namespace

RegularisedProfile::RegularisedProfile(const Profile& profile, double cellRadiusMm)
    : profile_(profile), a_(cellRadiusMm), isSingular_(profile.singularAtZero()) {
    if (!isSingular_) return;
    double sum = 0, faded = 0;
    const double edges[] = {0.0, a_, kBlendFrom * a_, kBlendTo * a_};
    for (int k = 0; k < 3; ++k) {
        const auto ring = [&](double r) { return 2.0 * kPi * r * (*this)(r); };
        sum += gauss16(edges[k], edges[k + 1], ring);
        faded += gauss16(edges[k], edges[k + 1],
                         [&](double r) { return ring(r) * fade(r / (kBlendTo * a_)); });
    }
    const double excess = sum - (profile.total() - profile.tail(kBlendTo * a_));
    if (faded > 0) correction_ = std::min(0.5, excess / faded);
}

// (1 / (pi a^2)) integral of R(s) s arc(s) ds: whole circles by the profile's tail, the others by
// s = mid - half cos(phi), which makes the square-root ends of the arc smooth.
double RegularisedProfile::average(double rMm) const {
    double sum = rMm < a_ ? profile_.total() - profile_.tail(a_ - rMm) : 0.0;
    constexpr std::size_t kSteps = 48;
    std::array<float, kSteps> radii, values;
    const double inner = std::abs(a_ - rMm), outer = a_ + rMm;
    const double mid = 0.5 * (inner + outer), half = 0.5 * (outer - inner);
    const auto phi = [](std::size_t i) { return (static_cast<double>(i) + 0.5) / kSteps * kPi; };
    for (std::size_t i = 0; i < kSteps; ++i)
        radii[i] = static_cast<float>(mid - half * std::cos(phi(i)));
    profile_.reflectance(radii, values);
    for (std::size_t i = 0; i < kSteps; ++i) {
        const double s = mid - half * std::cos(phi(i));
        sum += static_cast<double>(values[i]) * s * arcInsideDisk(s, rMm, a_) * half *
               std::sin(phi(i)) * kPi / kSteps;
    }
    return sum / (kPi * a_ * a_);
}

double RegularisedProfile::operator()(double rMm) const {
    if (!isSingular_ || rMm >= kBlendTo * a_) return profile_.reflectance(rMm);
    const double blend = fade(std::max(0.0, rMm / a_ - kBlendFrom) / (kBlendTo - kBlendFrom));
    double value = blend * average(rMm);
    if (blend < 1.0) value += (1.0 - blend) * profile_.reflectance(rMm);
    // A share of it, not a constant: a cell of many mean free paths leaves a long tail alone.
    return value * (1.0 - correction_ * fade(rMm / (kBlendTo * a_)));
}

}  // namespace sss
