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
    Rgb estimate(const SurfaceHit& hit, Sampler& sampler, PathCounts& counts) const {
        const Arrivals light = arrivals(hit, sampler, counts);
        return light.direct.irradiance + light.scattered.irradiance;
    }
    /// Light that arrives from one direction (unit, away from the surface); 0 if none does.
    struct Arrival {
        Rgb irradiance{0.0f};
        Vec3 from{0};
    };
    /// The two parts of an estimate, which add up to it, and where each comes from.
    struct Arrivals {
        Arrival direct, scattered;
    };
    Arrivals arrivals(const SurfaceHit& hit, Sampler& sampler, PathCounts& counts) const;
    /// The normal that they count by.
    static Vec3 normalOf(const SurfaceHit& hit) {
        return glm::dot(hit.shadingNormal, hit.geometricNormal) > 0 ? hit.shadingNormal
                                                                    : hit.geometricNormal;
    }

private:
    Arrival direct(const SurfaceHit& hit, const Vec3& normal, const Vec3& from, Sampler& sampler,
                   PathCounts& counts) const;
    /// Along a cosine-distributed direction: lights that scattering finds, and indirect light.
    Arrival scattered(const SurfaceHit& hit, const Vec3& normal, const Vec3& from, Sampler& sampler,
                      PathCounts& counts) const;

    const World& world_;
    const PathTracer& tracer_;
    float eta_;
};

}  // namespace sss
