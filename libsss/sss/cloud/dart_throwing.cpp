#include "sss/cloud/dart_throwing.h"

#include "sss/base/parallel.h"
#include "sss/base/rng.h"
#include "sss/cloud/cell_grid.h"

#include <algorithm>
#include <array>

namespace sss {
namespace {

constexpr std::uint32_t kNoBlocker = 0xffffffffu;

class DartBoard {
public:
    DartBoard(std::span<const Vec3> positions, std::span<const Vec3> normals, double radiusMm)
        : positions_(positions),
          normals_(normals),
          grid_(positions, radiusMm),
          radiusSquared_(static_cast<float>(radiusMm * radiusMm)) {}

    void throwAll(std::uint64_t seed, std::span<std::uint32_t> blocker) {
        listCandidates(seed);
        std::array<std::vector<std::uint32_t>, 27> phases;
        for (std::uint32_t c = 0; c < grid_.cellCount(); ++c)
            phases[static_cast<std::size_t>(grid_.phase(c))].push_back(c);
        // Cells of one phase are two cells apart: what one chooses cannot touch another's choice.
        // First trials of all phases come before second ones, so that no cell fills up first.
        bool any = true;
        for (std::uint32_t trial = 0; any; ++trial) {
            any = false;
            for (auto& cells : phases) {
                std::erase_if(cells, [&](std::uint32_t c) { return trial >= candidateCount(c); });
                any = any || !cells.empty();
                parallelFor(cells.size(), 256, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t k = begin; k < end; ++k) tryOne(cells[k], trial, blocker);
                });
            }
        }
    }

private:
    std::uint32_t candidateCount(std::uint32_t cell) const {
        return first_[cell + 1] - first_[cell];
    }

    // Candidates by cell, in random order within it.
    void listCandidates(std::uint64_t seed) {
        first_.assign(grid_.cellCount() + 1, 0);
        for (std::size_t i = 0; i < positions_.size(); ++i) ++first_[grid_.cellOf(i) + 1];
        for (std::size_t c = 0; c < grid_.cellCount(); ++c) first_[c + 1] += first_[c];
        candidates_.resize(positions_.size());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t i = 0; i < positions_.size(); ++i)
            candidates_[next[grid_.cellOf(i)]++] = static_cast<std::uint32_t>(i);
        chosen_.assign(grid_.cellCount(), 0);
        const auto earlier = [seed](std::uint32_t a, std::uint32_t b) {
            const std::uint64_t ka = combineSeeds(seed, a), kb = combineSeeds(seed, b);
            return ka != kb ? ka < kb : a < b;
        };
        parallelFor(grid_.cellCount(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c)
                std::sort(candidates_.begin() + first_[c], candidates_.begin() + first_[c + 1],
                          earlier);
        });
    }

    void tryOne(std::uint32_t cell, std::uint32_t trial, std::span<std::uint32_t> blocker) {
        const std::uint32_t slot = first_[cell] + trial;
        const std::uint32_t candidate = candidates_[slot];
        blocker[candidate] = findBlocker(candidate, cell);
        if (blocker[candidate] != kNoBlocker) return;
        blocker[candidate] = candidate;
        // The chosen ones of a cell stand at its front; what moves back was tried before.
        std::swap(candidates_[slot], candidates_[first_[cell] + chosen_[cell]++]);
    }

    std::uint32_t findBlocker(std::uint32_t candidate, std::uint32_t cell) const {
        for (const std::uint32_t near : grid_.neighbours(cell)) {
            const std::uint32_t begin = first_[near], end = begin + chosen_[near];
            for (std::uint32_t s = begin; s < end; ++s) {
                const std::uint32_t rival = candidates_[s];
                const Vec3 d = positions_[rival] - positions_[candidate];
                if (glm::dot(d, d) < radiusSquared_ &&
                    glm::dot(normals_[rival], normals_[candidate]) > 0.0f)
                    return rival;
            }
        }
        return kNoBlocker;
    }

    std::span<const Vec3> positions_, normals_;
    CellGrid grid_;
    float radiusSquared_;
    std::vector<std::uint32_t> first_;  // per cell, into candidates_
    std::vector<std::uint32_t> candidates_;
    std::vector<std::uint32_t> chosen_;  // per cell, how many at its front
};

}  // namespace

DartThrow throwDarts(std::span<const Vec3> positions, std::span<const Vec3> normals,
                     double radiusMm, std::uint64_t seed) {
    DartThrow result;
    result.blocker.assign(positions.size(), kNoBlocker);
    if (positions.empty()) return result;
    DartBoard(positions, normals, radiusMm).throwAll(seed, result.blocker);
    for (std::uint32_t i = 0; i < positions.size(); ++i)
        if (result.blocker[i] == i) result.chosen.push_back(i);
    return result;
}

}  // namespace sss
