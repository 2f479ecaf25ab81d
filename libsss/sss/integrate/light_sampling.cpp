#include "sss/integrate/light_sampling.h"

namespace sss {
namespace {

// A shadow ray stops short of the light by this share, for lights that are geometry.
constexpr float kShadowShare = 1.0f - 1e-4f;

}  // namespace

DirectSample sampleDirect(const World& world, const Vec3& from, float uPick, const Vec2& u) {
    DirectSample result;
    if (world.picker().empty()) return result;
    const LightPicker::Pick pick = world.picker().pick(uPick);
    const Light& light = *world.lights()[pick.index];
    const LightSample sample = light.sample(from, u);
    if (!(sample.pdf > 0) || isZero(sample.radiance)) return result;
    result.direction = sample.direction;
    result.distance = sample.distance;
    result.isDelta = light.isDelta();
    result.pdf = sample.pdf * pick.pmf;
    result.radianceOverPdf = sample.radiance / result.pdf;
    return result;
}

bool isVisible(const World& world, const Vec3& from, const DirectSample& sample) {
    Ray ray;
    ray.origin = from;
    ray.direction = sample.direction;
    ray.tMax = sample.distance * kShadowShare;
    return !world.rays().occluded(ray);
}

Rgb radianceOfLights(const World& world, const Ray& ray, float distance,
                     const ScatterOrigin& origin) {
    Rgb sum(0);
    const float behind = glm::dot(ray.origin - origin.sampledFrom, ray.direction);
    for (std::size_t k = 0; k < world.lights().size(); ++k) {
        const Light& light = *world.lights()[k];
        if (light.isDelta()) continue;
        const bool isSampled = std::isfinite(origin.pdf);
        const Light::Seen seen =
            light.seen(isSampled ? origin.sampledFrom : ray.origin, ray.direction);
        const float seenDistance = seen.distance - (isSampled ? behind : 0.0f);
        if (isZero(seen.radiance) || seenDistance > distance) continue;
        sum += seen.radiance * powerHeuristic(origin.pdf, seen.pdf * world.picker().pmf(k));
    }
    return sum;
}

Rgb radianceOfEmitter(const World& world, const Ray& ray, const SurfaceHit& hit,
                      const ScatterOrigin& origin) {
    const MeshLight* emitter = world.emitter(hit.object);
    if (!emitter) return Rgb(0);
    const Rgb radiance = emitter->radianceTowards(ray.direction, hit.geometricNormal);
    if (isZero(radiance) || std::isinf(origin.pdf)) return radiance;
    const float pdf = emitter->pdfForHit(origin.sampledFrom, hit.position, hit.geometricNormal) *
                      world.picker().pmf(world.emitterIndex(hit.object));
    return radiance * powerHeuristic(origin.pdf, pdf);
}

}  // namespace sss
