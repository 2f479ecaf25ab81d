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

// In cell radii: the disk that is averaged over.
constexpr double kRim = 1.6;
// In cell radii: where the average begins to give way to the profile itself, and where it has.
constexpr double kBlendFrom = 2.5, kBlendTo = 5.0;

}  // namespace

RegularisedProfile::RegularisedProfile(const Profile& profile, double cellRadiusMm)
    : profile_(profile),
      a_(cellRadiusMm),
      rim_(kRim * cellRadiusMm),
      isSingular_(profile.singularAtZero()) {
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

// Integral of (1 - rho^2 / R^2)^2 by the angle over the part within the disk of a circle of radius
// s around a place at distance r from the disk's middle: rho^2 = r^2 + s^2 - 2 r s cos.
double RegularisedProfile::weightOfCircle(double s, double rMm) const {
    if (s >= rim_ + rMm || s <= rMm - rim_) return 0.0;
    const double square = rim_ * rim_;
    const double half =  // of the arc
        s <= rim_ - rMm
            ? kPi
            : std::acos(std::clamp((rMm * rMm + s * s - square) / (2.0 * rMm * s), -1.0, 1.0));
    const double mean = 1.0 - (rMm * rMm + s * s) / square, swing = 2.0 * rMm * s / square;
    return 2.0 * (mean * mean + 0.5 * swing * swing) * half +
           swing * (4.0 * mean + swing * std::cos(half)) * std::sin(half);
}

// Integral of R(s) s (weight of the circle - `without`) ds, with s = mid - half cos(phi), which
// makes the square-root ends of arcs smooth.
double RegularisedProfile::overCircles(double from, double to, double rMm, double without) const {
    constexpr int kPanels = 2;
    constexpr std::size_t kSteps = kPanels * kGauss16.size();
    std::array<float, kSteps> radii, values;
    std::array<double, kSteps> s, weight;
    const double mid = 0.5 * (from + to), half = 0.5 * (to - from), panel = kPi / kPanels;
    std::size_t k = 0;
    for (int p = 0; p < kPanels; ++p)
        for (const GaussPoint& point : kGauss16) {
            const double phi = (p + point.node) * panel;
            s[k] = mid - half * std::cos(phi);
            weight[k] = point.weight * panel * half * std::sin(phi);
            radii[k] = static_cast<float>(s[k]);
            ++k;
        }
    profile_.reflectance(radii, values);
    double sum = 0;
    for (std::size_t i = 0; i < kSteps; ++i)
        sum += weight[i] * static_cast<double>(values[i]) * s[i] *
               (weightOfCircle(s[i], rMm) - without);
    return sum;
}

// Whole circles by the profile's tail, with the weight at the place itself, and by what other
// weights differ from that, which leaves no singularity; the other circles by quadrature.
double RegularisedProfile::average(double rMm) const {
    double sum = overCircles(std::abs(rim_ - rMm), rim_ + rMm, rMm, 0);
    if (rMm < rim_) {
        const double share = 1.0 - (rMm / rim_) * (rMm / rim_), here = share * share;
        sum += here * (profile_.total() - profile_.tail(rim_ - rMm)) +
               overCircles(0, rim_ - rMm, rMm, 2.0 * kPi * here);
    }
    return 3.0 * sum / (kPi * rim_ * rim_);
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
