#pragma once
#include "sss/cloud/candidates.h"
#include "sss/cloud/error_bound.h"
#include "sss/cloud/interactions.h"
#include "sss/cloud/kernel_table.h"
#include "sss/cloud/local_expansion.h"
#include "sss/cloud/node_list.h"
#include "sss/cloud/octree.h"
#include "sss/cloud/point_cloud.h"
#include "sss/cloud/receiver_tree.h"

#include <array>
#include <cstdint>
#include <deque>
#include <span>

namespace sss {

/// What a sum cost, for the statistics.
struct SumCounts {
    std::uint64_t receivers = 0;
    std::uint64_t localInteractions = 0;  ///< cell of receivers x node
    std::uint64_t nodeInteractions = 0;   ///< receiver x node
    std::uint64_t pointInteractions = 0;  ///< receiver x point
    std::uint64_t nodesVisited = 0;       ///< by cells
    /// Of these, left with all below them: no flux, or farther than the profile reaches.
    std::uint64_t nodesSkipped = 0;
    std::uint64_t pointsSkipped = 0;  ///< points without flux, met by cells in opened leaves
    std::uint64_t groups = 0;
    std::uint64_t repeats = 0;  ///< of leaves whose bounds added up to too much

    void add(const SumCounts& other);
    std::uint64_t interactions() const {
        return localInteractions + nodeInteractions + pointInteractions;
    }
};

/// Radiant exitance M(x) = sum over points of R_d(|x - p|) E_p A_p [JB02], W m^-2 per channel, for
/// groups of neighbouring receivers over the octree. Const and thread-safe; one scratch a thread.
///
/// Two trees meet: the points' and that of the group's receivers. What is far from a cell of
/// receivers is added once for the whole cell, as a polynomial of second order (LocalExpansion);
/// what is nearer is left to its halves; a leaf of a few receivers takes nodes by their flux and
/// second moments, and at last points.
///
/// Error control. A node is taken whole if a bound of what that leaves out (third derivative of R_d
/// over the node as seen from anywhere in the cell, and the differences between the channels'
/// moments) is below a share of tolerance x M; the shares are made smaller until the bounds add up
/// to what is asked for. tolerance 0 sums over all points.
class DiffusionSum {
public:
    DiffusionSum(const CloudView& cloud, std::span<const OctreeNode> nodes,
                 const KernelTable& table);

    /// Reusable memory of one thread.
    struct Scratch {
        InteractionList locals, nodes, points;
        NodeList root;                  ///< the octree's root
        NodeList taken;                 ///< nodes that are taken whole
        NodeList leaves;                ///< whose points are taken one by one
        std::array<NodeList, 2> fresh;  ///< children of opened nodes
        std::deque<NodeList> pending;   ///< left to a cell's halves, one for each depth
        std::vector<std::uint32_t> stack;
        std::vector<ReceiverCell> cells;
        std::vector<std::uint32_t> order;  ///< receivers by cell
        std::vector<Vec3> ordered;         ///< their positions in that order
        std::vector<DRgb> sums;            ///< in that order
    };

    /// `out[i]` = M at receivers[i] (mm, body space). The answer of a receiver depends on its
    /// group, within the tolerance: callers that want repeatable bytes use fixed groups. Throws
    /// Error{BadInput} if the cloud lies in a file that is damaged where it is needed.
    void evaluate(std::span<const Vec3> receivers, double tolerance, std::span<Rgb> out,
                  Scratch& scratch, SumCounts& counts) const;
    /// The sum over all points, in double: the oracle.
    DRgb bruteForce(const Vec3& receiver) const;

private:
    struct Goal {
        double tolerance;
        Rgb threshold;  ///< what a node may leave out, W m^-2
    };
    /// What a cell of receivers inherits: the nodes that are left to it, what the others add, and
    /// the bounds of what that left out.
    struct Inherited {
        const NodeList* left;
        LocalExpansion far;
        ErrorBound error;
        Goal goal;
        std::size_t depth;
    };
    DRgb estimate(const ReceiverCell& cell, Scratch& scratch, SumCounts& counts) const;
    /// Takes what is far from an inner cell and goes on with its halves.
    void descend(const ReceiverCell& cell, const Inherited& from, Scratch& scratch,
                 SumCounts& counts) const;
    /// Sums of a leaf's receivers.
    void finish(const ReceiverCell& leaf, const Inherited& from, Scratch& scratch,
                SumCounts& counts) const;
    /// Decides about the nodes `from` and those below: which are taken whole (into `locals` where
    /// there are halves to go on with, else `nodes`), which are left to the halves (`pending`), and
    /// which points are taken one by one. Returns the bounds of what is left out.
    ErrorBound gather(const CellTest& cell, const NodeList& from, NodeList* pending,
                      Scratch& scratch, SumCounts& counts) const;
    // Before looking at them; they may lie in a file unread.
    void needNodes(std::uint32_t first, std::uint32_t count) const;
    void needPoints(std::uint32_t first, std::uint32_t count) const;
    void addPoints(const OctreeNode& leaf, InteractionList& points, SumCounts& counts) const;

    CloudView cloud_;
    std::span<const OctreeNode> nodes_;
    const KernelTable& table_;
    float mostLeafRadius_;
};

}  // namespace sss
