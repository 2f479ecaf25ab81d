#include "sss/integrate/spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sss {
namespace {

// RMS error asked of the points under even light: the largest error on a body is three to four
// times the RMS, and light edges that cut through cells cost as much again.
constexpr double kShareOfTolerance = 0.15;
constexpr double kFactor = 0.125, kPowerOfW = 1.5, kPowerOfH = 3.2;
// Coarser than this the rule was not measured, and cells are no longer small against the kernel.
constexpr double kCoarsest = 1.5;

}  // namespace

double profileConcentration(const Profile& profile, double meanFreePathMm) {
    // Integral of 2 pi r R^2 over log r, from far inside to far outside the mean free path.
    const double total = profile.total();
    if (!(total > 0)) return 0;
    constexpr int kSteps = 400;
    const double lo = std::log(1e-4), hi = std::log(1e3);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double r = meanFreePathMm * std::exp(lo + (i + 0.5) / kSteps * (hi - lo));
        const double value = profile.reflectance(r);
        sum += 2.0 * kPi * r * r * value * value * (hi - lo) / kSteps;
    }
    return meanFreePathMm * std::sqrt(sum) / total;
}

SpacingRule spacingFor(const BodyOptics& optics, double tolerance) {
    SpacingRule rule;
    rule.spacingMm = std::numeric_limits<double>::infinity();
    rule.expectedRmsError = kShareOfTolerance * tolerance;
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium medium = optics.material.medium.channel(c);
        if (!(medium.sigmaSPrime() > 0)) continue;  // nothing leaves in this channel
        if (optics.firstLike(c) < c) continue;      // as that one
        const double l = medium.meanFreePathMm();
        const double w = profileConcentration(*optics.profiles[static_cast<std::size_t>(c)], l);
        const double perMfp =
            std::pow(rule.expectedRmsError / (kFactor * std::pow(w, kPowerOfW)), 1.0 / kPowerOfH);
        const double spacing = l * std::min(perMfp, kCoarsest);
        if (spacing < rule.spacingMm) {
            rule.spacingMm = spacing;
            rule.channel = c;
        }
    }
    return rule;
}

double expectedQuadratureError(const BodyOptics& optics, double spacingMm) {
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium medium = optics.material.medium.channel(c);
        if (!(medium.sigmaSPrime() > 0) || optics.firstLike(c) < c) continue;
        const double l = medium.meanFreePathMm();
        const double w = profileConcentration(*optics.profiles[static_cast<std::size_t>(c)], l);
        worst =
            std::max(worst, kFactor * std::pow(w, kPowerOfW) * std::pow(spacingMm / l, kPowerOfH));
    }
    return worst;
}

}  // namespace sss
