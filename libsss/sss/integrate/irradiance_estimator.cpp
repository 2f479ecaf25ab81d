#include "sss/integrate/irradiance_estimator.h"

#include "sss/base/warp.h"
#include "sss/integrate/arriving_light.h"
#include "sss/optics/fresnel.h"

namespace sss {

Rgb IrradianceEstimator::estimate(const SurfaceHit& hit, Sampler& sampler,
                                  PathCounts& counts) const {
    Vec3 normal = hit.shadingNormal;
    if (glm::dot(normal, hit.geometricNormal) <= 0) normal = hit.geometricNormal;
    const Vec3 from = world_.leave(hit, hit.geometricNormal);
    return direct(hit, normal, from, sampler, counts) +
           scattered(hit, normal, from, sampler, counts);
}

Rgb IrradianceEstimator::direct(const SurfaceHit& hit, const Vec3& normal, const Vec3& from,
                                Sampler& sampler, PathCounts& counts) const {
    const DirectSample light = sampleDirect(world_, from, hit.geometricNormal, sampler);
    if (!(light.pdf > 0)) return Rgb(0);
    const float cosine = glm::dot(light.direction, normal);
    if (cosine <= 0 || glm::dot(light.direction, hit.geometricNormal) <= 0) return Rgb(0);
    const Rgb share = arrivingShare(world_, from, light, counts.rays);
    if (isZero(share)) return Rgb(0);
    const float weight = light.isDelta ? 1.0f : powerHeuristic(light.pdf, cosine / kPiF);
    return share * light.radianceOverPdf *
           (cosine * (1.0f - fresnelReflectance(cosine, eta_)) * weight);
}

Rgb IrradianceEstimator::scattered(const SurfaceHit& hit, const Vec3& normal, const Vec3& from,
                                   Sampler& sampler, PathCounts& counts) const {
    const Vec3 local = cosineDirection(sampler.next2D());
    const float cosine = local.z;
    Ray ray;
    ray.origin = from;
    ray.direction = Frame(normal).toWorld(local);
    if (cosine <= 0 || glm::dot(ray.direction, hit.geometricNormal) <= 0) return Rgb(0);
    const ScatterOrigin origin{from, cosine / kPiF};
    return tracer_.incoming(ray, origin, world_.scene().quality.bounces, sampler, counts) *
           ((1.0f - fresnelReflectance(cosine, eta_)) * kPiF);
}

}  // namespace sss
