#pragma once
#include "sss/integrate/entry_sampler.h"
#include "sss/integrate/exitance_source.h"
#include "sss/integrate/irradiance_estimator.h"
#include "sss/integrate/path_tracer.h"

#include <memory>
#include <span>
#include <vector>

namespace sss {

/// Exitance by chance, without pass 1: light is looked for at one sampled place of the body's
/// surface each time, as pass 1 looks for it at its points, so that the mean is what the sum over
/// ever more points tends to.
class BssrdfExitance : public ExitanceSource {
public:
    /// `optics` by body. All outlive the source.
    BssrdfExitance(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics);
    BssrdfExitance(const BssrdfExitance&) = delete;
    BssrdfExitance& operator=(const BssrdfExitance&) = delete;
    Rgb exitance(const SurfaceHit& hit, const Vec3& wo, Sampler& sampler,
                 PathCounts& counts) const override;

private:
    struct BodySource {
        EntrySampler entries;
        IrradianceEstimator irradiance;
    };
    PathTracer indirect_;  ///< bodies in their diffuse limit, as in pass 1
    std::vector<BodySource> bodies_;
};

}  // namespace sss
