#pragma once
#include "sss/base/distribution.h"
#include "sss/medium/profile.h"

#include <array>

namespace sss {

/// Distances from a place at which light may have entered that leaves there: the mean over the
/// channels of their profiles, each brought to a total of 1, on the disk around the place. Each
/// channel's share of the samples, weighed by the balance heuristic, comes to the same.
class ProbeRadius {
public:
    /// Distances up to `reachMm`. `profiles` may hold the same pointer more than once.
    ProbeRadius(const std::array<const Profile*, 3>& profiles, double reachMm);

    /// Whether no channel scatters anything; then there is nothing to sample.
    bool isEmpty() const { return !(cells_.total() > 0); }
    /// mm, from u in [0, 1), increasing.
    float sample(float u) const;
    /// Density on the disk, mm^-2: its integral over the disk of radius `reachMm` is 1. Like 1/r,
    /// as the most singular of the profiles, at r = 0, where it is infinite.
    float density(float rMm) const;

private:
    double radiusAt(double x) const;
    float scale_;     ///< mm; below it cells are of even width, above of even ratio
    float exponent_;  ///< r = scale (e^{exponent x} - 1), x in [0, 1)
    PiecewiseConstant1D cells_;
};

}  // namespace sss
