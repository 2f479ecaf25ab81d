#pragma once
#include "sss/cloud/error_bound.h"
#include "sss/cloud/kernel_table.h"
#include "sss/cloud/octree.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace sss {

/// A cell of receivers: those within `radius` mm of the centre. Sums are expanded around a place
/// that no receiver is farther from than `reach` mm.
struct CellTest {
    Vec3 centre;
    float radius = 0, reach = 0;
    Rgb threshold;  ///< what a node may leave out
};

/// Bit i: candidate i may be taken whole; adds so little that it may be left out; cannot be opened,
/// or is smaller than the cell.
struct Verdict {
    std::uint64_t taken = 0, dark = 0, fine = 0;
};

/// Nodes that are judged at a time.
inline constexpr std::size_t kMostJudged = 64;

/// Judges the nodes with these indices, at most kMostJudged, and adds the remainders of those that
/// may be taken to `error`. Nodes are read where they lie.
Verdict judge(const KernelTable& table, std::span<const OctreeNode> nodes,
              std::span<const std::uint32_t> indices, const CellTest& cell, ErrorBound& error);
/// The same in plain C++: the reference that the vector code is tested against.
Verdict judgeScalar(const KernelTable& table, std::span<const OctreeNode> nodes,
                    std::span<const std::uint32_t> indices, const CellTest& cell,
                    ErrorBound& error);

}  // namespace sss
