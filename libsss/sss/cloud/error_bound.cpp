#include "sss/cloud/error_bound.h"

#include <cmath>

namespace sss {
namespace {

// What a node leaves out is bounded by the worst direction at the nearest place. True remainders
// are of third order, with signs that change from node to node: their bounds are added in
// quadrature, and the root of that sum may be this much above the tolerance.
constexpr double kBoundSlack = 12.0;
// The same for what channels leave out: of one sign at most, but not of the worst direction
// everywhere. Light that is red on one half of a body and blue on the other keeps its tolerance at
// 10 as well.
constexpr double kSteadySlack = 2.5;
// The share of the tolerance that one node may take at tolerance 0.01. The finer the sum the more
// nodes there are, about by this power of the tolerance.
constexpr double kNodeShare = 0.6, kSharePower = 0.35;
// Held by diffusion_sum_test for half-lit, coloured, thin and lumpy bodies, four media, all kinds
// of profiles, groups and single receivers and tolerances from 0.1 to 0.0001. What limits the share
// is the bias, always dark, of single receivers: with a share of 0.8 it came above a tenth of the
// tolerance.

}  // namespace

void ErrorBound::add(const ErrorBound& other) {
    changing += other.changing;
    steady += other.steady;
}

DRgb ErrorBound::total() const { return glm::sqrt(changing) / kBoundSlack + steady / kSteadySlack; }

double nodeShare(double tolerance) {
    return tolerance * kNodeShare * std::pow(tolerance / 0.01, kSharePower);
}

Rgb shareScale(const Rgb& share) {
    // Below this single precision ends.
    constexpr float kLeast = 1e-37f;
    Rgb scale;
    for (int c = 0; c < 3; ++c) scale[c] = share[c] > kLeast ? 1.0f / share[c] : 0.0f;
    return scale;
}

}  // namespace sss
