#pragma once
#include "sss/cloud/diffusion_sum.h"
#include "sss/cloud/exitance_sites.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace sss {

struct ExitanceCounts {
    SumCounts sums;
    std::uint64_t groups = 0;       ///< computed, of all that there are
    std::uint64_t sites = 0;        ///< computed
    std::uint64_t refinements = 0;  ///< groups done again with twice the segments
};

/// Radiant exitance of one body as a function on its surface. Multiple scattering leaves the same
/// way whoever looks, and smoothly on the scale of the mean free path: it is computed once at sites
/// bound to the mesh, only where somebody asks, and interpolated linearly in between.
///
/// Error control: in every group the places where the values differ most are probed between sites;
/// where interpolation misses by more than half the tolerance, the group gets twice the segments.
/// Thread-safe; a group is computed by whoever asks first, and comes out the same whoever that is.
class ExitanceField {
public:
    /// All must outlive the field. `tolerance` 0 = no hierarchy, no refinement limit but the
    /// grid's.
    ExitanceField(const TriangleMesh& mesh, const DiffusionSum& sum, double segmentMm,
                  double tolerance);
    ~ExitanceField();
    ExitanceField(const ExitanceField&) = delete;
    ExitanceField& operator=(const ExitanceField&) = delete;

    /// M at a place of the surface, W m^-2 per channel.
    Rgb at(FaceIndex face, const Vec2& barycentrics) const;
    ExitanceCounts counts() const;
    const ExitanceSites& sites() const { return sites_; }

private:
    struct Group;
    const Group& group(std::uint32_t index) const;
    std::unique_ptr<Group> compute(std::uint32_t index) const;
    /// Largest relative miss at the group's probes.
    double interpolationError(const Group& group, std::span<const ExitanceSites::Patch> patches,
                              ExitanceCounts& spent) const;

    const DiffusionSum& sum_;
    ExitanceSites sites_;
    double tolerance_;
    mutable std::vector<std::atomic<const Group*>> groups_;
    mutable std::mutex countsMutex_;
    mutable ExitanceCounts counts_;
};

}  // namespace sss
