#pragma once
#include "sss/base/bounds.h"
#include "sss/cloud/point_cloud.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// One node of the linear octree. 96 bytes, as in the cache file. "Flux" is irradiance x area of
/// the points below, W m^-2 mm^2; moments are weighted by the mean flux over the channels.
struct OctreeNode {
    Vec3 centroid{};  ///< mean-flux-weighted; area-weighted where the node is dark
    Rgb flux{0.0f};
    float areaMm2 = 0;
    float moments[6]{};         ///< xx yy zz xy xz yz of sum w (p-c)(p-c)^T / sum w, mm^2
    float chromaticMoment = 0;  ///< largest norm of (a channel's second moment - `moments`), mm^2
    float cubicMean = 0;        ///< cube root of the largest over channels of
                                ///< sum w |p-c|^3 / sum w, mm: how far out the flux lies
    float radius = 0;           ///< of the sphere around the centroid that holds all points, mm
    Vec3 lean[2]{};           ///< of red and blue: sum of the channel's flux x (p - centroid) over
                              ///< the mean flux, mm; with green's they add up to 0
    std::uint32_t first = 0;  ///< first child (inner node) or first point (leaf)
    std::uint32_t count = 0;  ///< children of an inner node, or kLeaf | points of a leaf

    static constexpr std::uint32_t kLeaf = 0x80000000u;
    bool isLeaf() const { return (count & kLeaf) != 0; }
    std::uint32_t size() const { return count & ~kLeaf; }
    /// Mean of the flux over the channels.
    float meanFlux() const {
        constexpr float kThird = 1.0f / 3.0f;
        return kThird * flux.x + kThird * flux.y + kThird * flux.z;
    }
    bool isColoured() const { return !isZero(lean[0]) || !isZero(lean[1]); }
};
static_assert(sizeof(OctreeNode) == 96);

/// Sorts points into the order that buildOctree wants; returns old indices in the new order. Ties
/// (equal codes) are broken by position and then by old index.
std::vector<std::uint32_t> mortonOrder(std::span<const Vec3> positions);

/// The same for the points of a cloud in any order, by all that is in them: ties are broken by the
/// bytes of the point and then of its irradiance (which may be left empty), so that the same points
/// give the same cloud in whatever order they come.
std::vector<std::uint32_t> cloudOrder(const CloudView& cloud);

/// The octree of a cloud whose points stand in Morton order: breadth first, root at 0, nodes with
/// one child left out. Sums are taken in double over the points in their order, so that children
/// add up to their parent to the rounding of the stored floats. Leaves hold at most kLeafPoints,
/// but for points too close together to be told apart. O(N log N), parallel, deterministic.
/// An empty cloud gives no nodes.
inline constexpr std::uint32_t kLeafPoints = 8;
std::vector<OctreeNode> buildOctree(const CloudView& cloud);

}  // namespace sss
