#pragma once
#include "sss/base/vec.h"
#include "sss/cloud/interactions.h"
#include "sss/cloud/kernel_table.h"

#include <array>

namespace sss {

/// What far sources add around a place, as a polynomial of second order in the distance from it:
/// once for a whole cell of receivers instead of once for each.
struct LocalExpansion {
    Vec3 centre{0};
    DRgb value{0};
    std::array<DRgb, 3> gradient{DRgb(0), DRgb(0), DRgb(0)};
    /// xx yy zz xy xz yz
    std::array<DRgb, 6> hessian{DRgb(0), DRgb(0), DRgb(0), DRgb(0), DRgb(0), DRgb(0)};

    DRgb at(const Vec3& place) const;
    /// The same polynomial around another place.
    LocalExpansion movedTo(const Vec3& place) const;
};

/// Adds the sources of a list of nodes. With d = centre - source and u = d^2, a source is there
/// f + f' tr Q + 2 f'' d^T Q d, grows by 2 f' d, and bends by 2 f' 1 + 4 f'' d d^T; f is its flux x
/// the kernel, primes by u. Channels that lie elsewhere than the centroid, by l x the mean flux
/// (OctreeNode::lean), add - 2 f' d l and that term's slope - 2 f' l - 4 f'' (d l) d, f then being
/// the kernel alone. What is left out is of third order in the receiver's distance from the centre
/// and the source's extent together.
void accumulate(const KernelTable& table, const InteractionList& nodes, LocalExpansion& expansion);
/// The same in plain C++: the reference that the vector code is tested against.
void accumulateScalar(const KernelTable& table, const InteractionList& nodes,
                      LocalExpansion& expansion);

}  // namespace sss
