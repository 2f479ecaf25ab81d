#include "sss/integrate/light_sampling.h"

namespace sss {
namespace {

// A shadow ray stops short of the light by this share, for lights that are geometry.
constexpr float kShadowShare = 1.0f - 1e-4f;

// Calls visit(weighted radiance, distance from the ray's origin) for each light along a ray of
// length `distance`, and for some that lie behind that.
template <typename Visit>
void forEachSeen(const World& world, const Ray& ray, float distance, const ScatterOrigin& origin,
                 const Visit& visit) {
    const bool isSampled = std::isfinite(origin.pdf);
    const Vec3& from = isSampled ? origin.sampledFrom : ray.origin;
    const float behind = isSampled ? glm::dot(ray.origin - from, ray.direction) : 0.0f;
    for (const World::VisibleLight& visible : world.visibleLights()) {
        if (visible.isInfinite && std::isfinite(distance)) continue;
        const Light::Seen seen = visible.light->seen(from, ray.direction);
        if (isZero(seen.radiance)) continue;
        visit(seen.radiance * powerHeuristic(origin.pdf, seen.pdf * visible.pmf),
              seen.distance - behind);
    }
}

}  // namespace

DirectSample sampleDirect(const World& world, const Vec3& from, float uPick, const Vec2& u) {
    if (world.picker().empty()) return {};
    return sampleDirect(world, world.picker().pick(uPick), from, u);
}

DirectSample sampleDirect(const World& world, const LightPicker::Pick& pick, const Vec3& from,
                          const Vec2& u) {
    DirectSample result;
    const Light& light = *world.lights()[pick.index];
    const LightSample sample = light.sample(from, u);
    if (!(sample.pdf > 0) || isZero(sample.radiance)) return result;
    result.direction = sample.direction;
    result.distance = sample.distance;
    result.isDelta = light.isDelta();
    result.volume = light.volume();
    result.pdf = sample.pdf * pick.pmf;
    result.radianceOverPdf = sample.radiance / result.pdf;
    return result;
}

DirectSample sampleDirect(const World& world, const Vec3& from, const Vec3& normal,
                          Sampler& sampler) {
    const LightPicker& picker = world.picker();
    if (picker.empty()) {
        sampler.skip(2);
        return {};
    }
    float uPick = 0;
    if (picker.hasChoice())
        uPick = sampler.next1D();
    else
        sampler.skip();
    const LightPicker::Pick pick = picker.pick(uPick);
    if (world.lights()[pick.index]->isBelow(from, normal)) {
        sampler.skip();
        return {};
    }
    return sampleDirect(world, pick, from, sampler.next2D());
}

Ray shadowRay(const Vec3& from, const DirectSample& sample) {
    return {from, sample.direction, 0.0f, sample.distance * kShadowShare};
}

Rgb radianceOfLights(const World& world, const Ray& ray, float distance,
                     const ScatterOrigin& origin) {
    Rgb sum(0);
    forEachSeen(world, ray, distance, origin, [&](const Rgb& radiance, float lightDistance) {
        if (lightDistance > distance) return;
        sum += world.hasVolumes()
                   ? radiance * world.volumesAlong(ray, lightDistance).transmittance()
                   : radiance;
    });
    return sum;
}

Rgb radianceOfOpenLights(const World& world, const Ray& ray, const ScatterOrigin& origin,
                         std::uint64_t& rays) {
    Rgb sum(0);
    bool isNear = false;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    forEachSeen(world, ray, kInfinity, origin, [&](const Rgb& radiance, float lightDistance) {
        sum += radiance;
        isNear = isNear || std::isfinite(lightDistance);
    });
    if (isZero(sum)) return sum;
    ++rays;
    if (!isNear) return world.rays().occluded(ray) ? Rgb(0) : sum;
    Hit hit;
    if (!world.rays().intersect(ray, hit)) return sum;
    return radianceOfLights(world, ray, hit.t, origin);
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
