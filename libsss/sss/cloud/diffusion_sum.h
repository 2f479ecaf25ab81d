#pragma once
#include "sss/cloud/interactions.h"
#include "sss/cloud/kernel_table.h"
#include "sss/cloud/octree.h"
#include "sss/cloud/point_cloud.h"

#include <cstdint>
#include <span>

namespace sss {

/// What a sum cost, for the statistics.
struct SumCounts {
    std::uint64_t receivers = 0;
    std::uint64_t nodeInteractions = 0;   ///< receiver x node
    std::uint64_t pointInteractions = 0;  ///< receiver x point
    std::uint64_t nodesVisited = 0;       ///< by groups
    std::uint64_t traversals = 0;         ///< groups, and repeats where the bound was missed

    void add(const SumCounts& other);
    std::uint64_t interactions() const { return nodeInteractions + pointInteractions; }
};

/// Radiant exitance M(x) = sum over points of R_d(|x - p|) E_p A_p [JB02], W m^-2 per channel, for
/// groups of neighbouring receivers over the octree. Const and thread-safe; one scratch a thread.
///
/// Error control. A node is taken whole, as its flux at its centroid with the second-order term of
/// its moments, if a bound of what that leaves out (third derivative of R_d over the node as seen
/// from anywhere in the group, and the differences between the channels' moments) is below a share
/// of tolerance x M; the shares are made smaller until the bounds add up to what is asked for.
/// tolerance 0 sums over all points.
///
/// The group takes what it can take as one; what is too near for that is left to clusters of a few
/// receivers each, whose bounds are far tighter, since they are seen from a smaller place.
class DiffusionSum {
public:
    DiffusionSum(const CloudView& cloud, std::span<const OctreeNode> nodes,
                 const KernelTable& table);

    /// Reusable memory of one thread.
    struct Scratch {
        InteractionList nodes, points;
        std::vector<std::uint32_t> stack, pending;
        std::vector<std::uint32_t> order;  ///< receivers by cluster
        std::vector<Vec3> clustered;       ///< their positions in that order
        std::vector<DRgb> shared, sums;
    };

    /// `out[i]` = M at receivers[i] (mm, body space). The answer of a receiver depends on its
    /// group, within the tolerance: callers that want repeatable bytes use fixed groups.
    void evaluate(std::span<const Vec3> receivers, double tolerance, std::span<Rgb> out,
                  Scratch& scratch, SumCounts& counts) const;
    /// The sum over all points, in double: the oracle.
    DRgb bruteForce(const Vec3& receiver) const;

private:
    struct Group {
        Vec3 centre;
        float radius;
    };
    static Group groupAround(std::span<const Vec3> receivers);
    DRgb estimate(const Group& group, Scratch& scratch, SumCounts& counts) const;
    /// Fills the lists from the nodes `from` down; returns the sum of the bounds of what was left
    /// out. Nodes smaller than the group that it cannot take whole are left to `pending`, if given.
    DRgb gather(const Group& group, const Rgb& threshold, std::span<const std::uint32_t> from,
                std::vector<std::uint32_t>* pending, Scratch& scratch, SumCounts& counts) const;
    void gatherLeaf(const OctreeNode& node, Scratch& scratch) const;
    /// Adds the lists to the sums of `receivers`.
    void addLists(std::span<const Vec3> receivers, std::span<DRgb> sums, Scratch& scratch,
                  SumCounts& counts) const;
    /// Sums of one cluster: what is left after the group's `shared` part and its `error`.
    struct Shared {
        std::span<const DRgb> sums;
        DRgb error;
        Rgb threshold;
    };
    void evaluateCluster(std::span<const Vec3> receivers, double tolerance, const Shared& shared,
                         Scratch& scratch, SumCounts& counts) const;

    CloudView cloud_;
    std::span<const OctreeNode> nodes_;
    const KernelTable& table_;
};

}  // namespace sss
