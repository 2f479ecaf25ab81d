#include "sss/cloud/candidates.h"

#include <algorithm>
#include <cmath>

namespace sss {

CandidateList::Block& CandidateList::room() {
    if (used_ == 0 || blocks_[used_ - 1].count == kBlock) {
        // Whole blocks are judged: what is not filled in has to be numbers.
        if (used_ == blocks_.size()) blocks_.emplace_back(Block{});
        blocks_[used_++].count = 0;
    }
    return blocks_[used_ - 1];
}

void CandidateList::add(const OctreeNode& node, std::uint32_t index) {
    Block& block = room();
    const std::uint32_t i = block.count++;
    block.x[i] = node.centroid.x;
    block.y[i] = node.centroid.y;
    block.z[i] = node.centroid.z;
    block.radius[i] = node.radius();
    block.extent[i] = node.cubicMean;
    for (int c = 0; c < 3; ++c) block.flux[c][i] = node.flux[c];
    block.offset[i] = node.chromaticOffset;
    block.difference[i] = node.chromaticMoment;
    block.node[i] = index;
}

void CandidateList::add(const Block& from, std::size_t k) {
    Block& block = room();
    const std::uint32_t i = block.count++;
    block.x[i] = from.x[k];
    block.y[i] = from.y[k];
    block.z[i] = from.z[k];
    block.radius[i] = from.radius[k];
    block.extent[i] = from.extent[k];
    for (int c = 0; c < 3; ++c) block.flux[c][i] = from.flux[c][k];
    block.offset[i] = from.offset[k];
    block.difference[i] = from.difference[k];
    block.node[i] = from.node[k];
}

Verdict judgeScalar(const KernelTable& table, const CandidateList::Block& block,
                    const CellTest& cell, ErrorBound& error) {
    Verdict verdict;
    const Rgb scale = shareScale(cell.threshold);
    for (std::uint32_t i = 0; i < block.count; ++i) {
        const float distance = glm::length(Vec3(block.x[i], block.y[i], block.z[i]) - cell.centre);
        const float nearest = std::max(0.0f, distance - cell.radius - block.radius[i]);
        const KernelTable::BoundsRow& bound = table.boundsAt(nearest * nearest);
        const float third = thirdOrder(block.extent[i], cell.reach);
        const float second = block.difference[i] * 0.5f + block.offset[i] * cell.reach;
        bool isDark = true, isTaken = true;
        Rgb changing, steady;
        for (int c = 0; c < 3; ++c) {
            const float flux = block.flux[c][i], threshold = cell.threshold[c];
            isDark &= flux * bound.derivative[0][c] <= threshold * kNegligibleShare;
            changing[c] = flux * (bound.derivative[3][c] * third);
            steady[c] =
                flux * (bound.derivative[2][c] * second + bound.derivative[1][c] * block.offset[i]);
            isTaken &= changing[c] + steady[c] * kSteadyWeight <= threshold;
        }
        const std::uint64_t bit = std::uint64_t{1} << i;
        if (isDark) verdict.dark |= bit;
        if (!isTaken || isDark) continue;
        verdict.taken |= bit;
        changing *= scale;
        error.changing += DRgb(changing * changing);
        error.steady += DRgb(steady * scale);
    }
    return verdict;
}

}  // namespace sss
