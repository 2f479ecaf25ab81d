#pragma once
#include "sss/base/vec.h"

namespace sss {

// What a node leaves out of the sum where it is taken as its moments has two parts, per channel:
// - of third order, flux x |distance from the centroid|^3 / 6 x third derivative: its sign changes
//   from node to node, and the parts are added in quadrature;
// - where the channels' moments differ from the mean's: of one sign over whole regions (red light
//   here, blue there); these are added as they stand and weigh more in a node's share.

inline constexpr float kSteadyWeight = 10.0f;
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

/// What a node may leave out relative to M, at a tolerance.
double nodeShare(double tolerance);

/// 1 / share, and 0 where there is none.
Rgb shareScale(const Rgb& share);

}  // namespace sss
