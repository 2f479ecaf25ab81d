#include "sss/integrate/irradiance_estimator.h"

#include "sss/base/warp.h"
#include "sss/integrate/arriving_light.h"
#include "sss/optics/fresnel.h"

namespace sss {

IrradianceEstimator::Arrivals IrradianceEstimator::arrivals(const SurfaceHit& hit, Sampler& sampler,
                                                            PathCounts& counts) const {
    const Vec3 normal = normalOf(hit);
    const Vec3 from = world_.leave(hit, hit.geometricNormal);
    const Arrival straight = direct(hit, normal, from, sampler, counts);
    return {straight, scattered(hit, normal, from, sampler, counts)};
}

IrradianceEstimator::Arrival IrradianceEstimator::direct(const SurfaceHit& hit, const Vec3& normal,
                                                         const Vec3& from, Sampler& sampler,
                                                         PathCounts& counts) const {
    const DirectSample light = sampleDirect(world_, from, hit.geometricNormal, sampler);
    if (!(light.pdf > 0)) return {};
    const float cosine = glm::dot(light.direction, normal);
    if (cosine <= 0 || glm::dot(light.direction, hit.geometricNormal) <= 0) return {};
    const Rgb share = arrivingShare(world_, from, light, counts.rays);
    if (isZero(share)) return {};
    const float weight = light.isDelta ? 1.0f : powerHeuristic(light.pdf, cosine / kPiF);
    return {share * light.radianceOverPdf *
                (cosine * (1.0f - fresnelReflectance(cosine, eta_)) * weight),
            light.direction};
}

IrradianceEstimator::Arrival IrradianceEstimator::scattered(const SurfaceHit& hit,
                                                            const Vec3& normal, const Vec3& from,
                                                            Sampler& sampler,
                                                            PathCounts& counts) const {
    const Vec3 local = cosineDirection(sampler.next2D());
    const float cosine = local.z;
    Ray ray;
    ray.origin = from;
    ray.direction = Frame(normal).toWorld(local);
    if (cosine <= 0 || glm::dot(ray.direction, hit.geometricNormal) <= 0) return {};
    const ScatterOrigin origin{from, cosine / kPiF};
    return {tracer_.incoming(ray, origin, world_.scene().quality.bounces, sampler, counts) *
                ((1.0f - fresnelReflectance(cosine, eta_)) * kPiF),
            ray.direction};
}

}  // namespace sss
