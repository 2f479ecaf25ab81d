#pragma once
#include "sss/base/sampler.h"
#include "sss/integrate/path_tracer.h"

namespace sss {

/// One light sample of a place on a body: an unbiased estimate of the transmitted irradiance
/// E = integral of L_i F_t(w_i) cos over the outer hemisphere, W m^-2, by one direction towards a
/// light and one cosine-distributed direction, weighed by the power heuristic. Const and
/// thread-safe.
class IrradianceEstimator {
public:
    /// `eta` of the body; all must outlive the estimator.
    IrradianceEstimator(const World& world, const PathTracer& tracer, float eta)
        : world_(world), tracer_(tracer), eta_(eta) {}
    Rgb estimate(const SurfaceHit& hit, Sampler& sampler, PathCounts& counts) const;

private:
    Rgb direct(const SurfaceHit& hit, const Vec3& normal, const Vec3& from, Sampler& sampler,
               PathCounts& counts) const;
    /// Along a cosine-distributed direction: lights that scattering finds, and indirect light.
    Rgb scattered(const SurfaceHit& hit, const Vec3& normal, const Vec3& from, Sampler& sampler,
                  PathCounts& counts) const;

    const World& world_;
    const PathTracer& tracer_;
    float eta_;
};

}  // namespace sss
