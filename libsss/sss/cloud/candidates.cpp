#include "sss/cloud/candidates.h"

#include <algorithm>
#include <cmath>

namespace sss {

Verdict judgeScalar(const KernelTable& table, std::span<const OctreeNode> nodes,
                    std::span<const std::uint32_t> indices, const CellTest& cell,
                    ErrorBound& error) {
    Verdict verdict;
    const Rgb scale = shareScale(cell.threshold);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const OctreeNode& node = nodes[indices[i]];
        const std::uint64_t bit = std::uint64_t{1} << i;
        const float radius = node.radius;
        if (node.isLeaf() || radius < cell.radius) verdict.fine |= bit;
        const float distance = glm::length(node.centroid - cell.centre);
        const float nearest = std::max(0.0f, distance - cell.radius - radius);
        const KernelTable::BoundsRow& bound = table.boundsAt(nearest * nearest);
        const float third = thirdOrder(node.cubicMean, cell.reach);
        const float second = node.chromaticMoment * 0.5f;
        bool isDark = true, isTaken = true;
        Rgb changing, steady;
        for (int c = 0; c < 3; ++c) {
            const float flux = node.flux[c], threshold = cell.threshold[c];
            const bool isDarkHere = flux * bound.derivative[0][c] <= threshold * kNegligibleShare;
            isDark &= isDarkHere;
            changing[c] = flux * (bound.derivative[3][c] * third);
            steady[c] = chromaticFlux(node.flux, c) * (bound.derivative[2][c] * second);
            // Where nothing may be left out, a bound of 0 may be one that single precision lost.
            isTaken &= changing[c] + steady[c] * kSteadyWeight <= threshold &&
                       (threshold > 0 || isDarkHere);
        }
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
