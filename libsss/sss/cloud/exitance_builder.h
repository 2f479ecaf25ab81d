#pragma once
#include "sss/cloud/diffusion_sum.h"
#include "sss/cloud/exitance_group.h"
#include "sss/cloud/exitance_sites.h"
#include "sss/cloud/point_interpolator.h"

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace sss {

struct ExitanceCounts {
    SumCounts sums;
    std::uint64_t groups = 0;       ///< computed, of all that there are
    std::uint64_t sites = 0;        ///< computed
    std::uint64_t refinements = 0;  ///< patches done again with twice the segments
    /// Patches that would need more sites than kMostLevels refinements give.
    std::uint64_t unsettled = 0;

    void add(const ExitanceCounts& other);
};

/// Computes the exitance of one group of patches, with as many sites as the tolerance asks for.
///
/// First the patches' corners; where these differ most, interpolation is compared with the sum, and
/// where it misses by more than its share of the tolerance, all edges are halved. From then on
/// every patch tells for itself: a new site's distance from what the coarser grid said there is
/// what that grid missed, and four times what the new one may. The sums and the interpolation
/// between them have half of the tolerance each, so that together they keep it. A patch is refined
/// three times at most; those that would need more are counted.
class ExitanceBuilder {
public:
    /// All must outlive the builder. `tolerance` 0: corners only, no hierarchy.
    /// `correction`, if any, is added to the sum everywhere.
    ExitanceBuilder(const ExitanceSites& sites, const DiffusionSum& sum,
                    const PointInterpolator* correction, double tolerance);
    ExitanceGroup build(std::uint32_t group, ExitanceCounts& counts);

private:
    struct PositionHash {
        std::size_t operator()(const Vec3& p) const;
    };
    std::uint32_t segmentsOf(std::size_t patch) const {
        return patches_[patch].segments << levels_[patch];
    }
    Vec3 positionOf(std::size_t patch, const Vec2& inPatch) const;
    /// Grids of all patches at their levels; sums at sites that are new.
    void layOut(ExitanceCounts& counts);
    void sumAt(std::span<const Vec3> positions, std::span<Rgb> values,
               std::span<ExitanceSlope> slopes, ExitanceCounts& counts);
    /// Largest relative miss at the places where the corners differ most.
    double missBetweenCorners(ExitanceCounts& counts);
    /// Largest relative distance of a patch's newest sites from what its coarser grid says there.
    double missOfCoarserGrid(std::size_t patch) const;

    const ExitanceSites& sites_;
    const DiffusionSum& sum_;
    const PointInterpolator* correction_;
    double tolerance_;
    std::vector<ExitanceSites::Patch> patches_;
    std::vector<std::uint8_t> levels_;
    std::unordered_map<Vec3, std::uint16_t, PositionHash> known_;
    ExitanceGroup group_;
    DiffusionSum::Scratch scratch_;
};

}  // namespace sss
