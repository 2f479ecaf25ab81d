#pragma once
#include "sss/base/vec.h"

#include <algorithm>

namespace sss {

// What a node leaves out of the sum where it is taken as its moments has two parts, per channel:
// - of third order, flux x |distance from the centroid|^3 / 6 x third derivative: its sign changes
//   from node to node, and the parts are added in quadrature. What is due to the receivers' own
//   distance from the place of expansion has one sign for all the nodes on one side and weighs
//   more;
// - where the channels' second moments differ from the mean's: of one sign over whole regions (red
//   light here, blue there); these are added as they stand and weigh more in a node's share. What
//   is of first order, that red lies elsewhere than blue, is not left out (OctreeNode::lean).

inline constexpr float kSteadyWeight = 4.0f;
/// At 1 a box of faces far larger than the mean free path misses a tolerance of 1 % at 1 % of the
/// receivers, at 2 at 0.3 %, at 4 nowhere.
inline constexpr float kReachWeight = 4.0f;
/// A node that adds less than this part of its share is left out. Leaving out is always dark, so it
/// must not add up to a bias: it takes ten thousands of such nodes to make a hundredth of a share.
inline constexpr float kNegligibleShare = 1e-6f;

/// The bounds of a whole sum, in shares: divided by what one node may leave out.
struct ErrorBound {
    DRgb changing{0};  ///< sum of squares
    DRgb steady{0};

    void add(const ErrorBound& other);
    /// Relative to the same unit as the shares; to be kept below tolerance x M.
    DRgb total() const;
};

/// |distance|^3 / 6 of the first part: mean over the node's flux, seen from within `reach` mm.
inline float thirdOrder(float extent, float reach) {
    const float both = extent + reach;
    return (kReachWeight * both * both * both - (kReachWeight - 1.0f) * extent * extent * extent) *
           (1.0f / 6.0f);
}

/// The flux that a channel's second moment can differ by, in units of the largest difference: at
/// most its own, and at most the others' together, since differences weighted by flux add up to 0.
inline float chromaticFlux(const Rgb& flux, int channel) {
    return std::min(flux[channel], flux[(channel + 1) % 3] + flux[(channel + 2) % 3]);
}

/// What a node may leave out relative to M, at a tolerance.
double nodeShare(double tolerance);

/// 1 / share, and 0 where there is none.
Rgb shareScale(const Rgb& share);

}  // namespace sss
