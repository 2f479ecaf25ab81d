#pragma once
#include "sss/cloud/diffusion_sum.h"
#include "sss/cloud/exitance_builder.h"
#include "sss/cloud/exitance_sites.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace sss {

/// Radiant exitance of one body as a function on its surface. Multiple scattering leaves the same
/// way whoever looks, and smoothly on the scale of the mean free path: it is computed once at sites
/// bound to the mesh, only where somebody asks, and interpolated in between (ExitanceBuilder says
/// how finely). Thread-safe; a group is computed by whoever asks first, and comes out the same
/// whoever that is.
class ExitanceField {
public:
    /// All must outlive the field. `tolerance` 0 = no hierarchy, no refinement. `correction`, if
    /// any, is added to the sum everywhere.
    ExitanceField(const TriangleMesh& mesh, const DiffusionSum& sum, double segmentMm,
                  double tolerance, const PointInterpolator* correction = nullptr);
    ~ExitanceField();
    ExitanceField(const ExitanceField&) = delete;
    ExitanceField& operator=(const ExitanceField&) = delete;

    /// M at a place of the surface, W m^-2 per channel.
    Rgb at(FaceIndex face, const Vec2& barycentrics) const;
    /// What it would be if all light left as that which goes `towards` (unit, space of the mesh).
    Rgb at(FaceIndex face, const Vec2& barycentrics, const Vec3& towards) const;
    ExitanceCounts counts() const;
    /// Takes a group that was computed before, for this mesh, sum, correction and tolerance. False,
    /// and nothing done, if it does not fit the mesh or is there already. Not while others ask.
    bool adopt(std::uint32_t index, ExitanceGroup group);
    /// All groups that are there, by index. Not while others ask.
    void forEachGroup(const std::function<void(std::uint32_t, const ExitanceGroup&)>& visit) const;
    const ExitanceSites& sites() const { return sites_; }

private:
    const ExitanceGroup& group(std::uint32_t index) const;
    std::unique_ptr<ExitanceGroup> compute(std::uint32_t index) const;
    /// A builder that nobody uses, with the memory it has grown; a new one if there is none.
    std::unique_ptr<ExitanceBuilder> idleBuilder() const;

    const DiffusionSum& sum_;
    const PointInterpolator* correction_;
    ExitanceSites sites_;
    double tolerance_;
    mutable std::vector<std::atomic<const ExitanceGroup*>> groups_;
    mutable std::mutex mutex_;  // of what follows
    mutable ExitanceCounts counts_;
    mutable std::vector<std::unique_ptr<ExitanceBuilder>> idle_;  // at most one a thread
};

}  // namespace sss
