#pragma once
#include "sss/cloud/error_bound.h"
#include "sss/cloud/kernel_table.h"
#include "sss/cloud/octree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Nodes of which a cell of receivers has yet to decide, laid out for straight vector loops.
class CandidateList {
public:
    static constexpr std::size_t kBlock = 64;
    struct alignas(64) Block {
        float x[kBlock], y[kBlock], z[kBlock];
        float radius[kBlock];      ///< OctreeNode::radius()
        float extent[kBlock];      ///< OctreeNode::cubicMean
        float flux[3][kBlock];     ///< [channel]
        float offset[kBlock];      ///< OctreeNode::chromaticOffset
        float difference[kBlock];  ///< OctreeNode::chromaticMoment
        std::uint32_t node[kBlock];
        std::uint32_t count = 0;
    };

    void clear() { used_ = 0; }
    void add(const OctreeNode& node, std::uint32_t index);
    /// Candidate i of another list's block.
    void add(const Block& block, std::size_t i);
    std::span<const Block> blocks() const { return std::span(blocks_).first(used_); }
    bool empty() const { return used_ == 0; }

private:
    Block& room();
    std::vector<Block> blocks_;
    std::size_t used_ = 0;
};

/// A cell of receivers: those within `radius` mm of the centre. Sums are expanded around a place
/// that no receiver is farther from than `reach` mm.
struct CellTest {
    Vec3 centre;
    float radius = 0, reach = 0;
    Rgb threshold;  ///< what a node may leave out
};

/// Bit i: candidate i of a block may be taken whole; adds so little that it may be left out.
struct Verdict {
    std::uint64_t taken = 0, dark = 0;
};

/// Judges a block and adds the remainders of the nodes that may be taken to `error`.
Verdict judge(const KernelTable& table, const CandidateList::Block& block, const CellTest& cell,
              ErrorBound& error);
/// The same in plain C++: the reference that the vector code is tested against.
Verdict judgeScalar(const KernelTable& table, const CandidateList::Block& block,
                    const CellTest& cell, ErrorBound& error);

}  // namespace sss
