#include "sss/integrate/light_sampling.h"

#include "sss/base/assert.h"
#include "sss/base/inline_vector.h"

#include <array>

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

DirectSample directSample(const Light& light, float pmf, const LightSample& sample) {
    DirectSample result;
    if (!(sample.pdf > 0) || isZero(sample.radiance)) return result;
    result.direction = sample.direction;
    result.distance = sample.distance;
    result.isDelta = light.isDelta();
    result.volume = light.volume();
    result.pdf = sample.pdf * pmf;
    result.radianceOverPdf = sample.radiance / result.pdf;
    return result;
}

}  // namespace

DirectSample sampleDirect(const World& world, const Vec3& from, float uPick, const Vec2& u) {
    if (world.picker().empty()) return {};
    return sampleDirect(world, world.picker().pick(uPick), from, u);
}

DirectSample sampleDirect(const World& world, const LightPicker::Pick& pick, const Vec3& from,
                          const Vec2& u) {
    const Light& light = *world.lights()[pick.index];
    return directSample(light, pick.pmf, light.sample(from, u));
}

std::optional<LightQuery> queryAbove(const World& world, const Vec3& from, const Vec3& normal,
                                     Sampler& sampler) {
    const LightPicker& picker = world.picker();
    if (picker.empty()) {
        sampler.skip(2);
        return std::nullopt;
    }
    float uPick = 0;
    if (picker.hasChoice())
        uPick = sampler.next1D();
    else
        sampler.skip();
    const LightPicker::Pick pick = picker.pick(uPick);
    if (!world.lights()[pick.index]->isBelow(from, normal))
        return LightQuery{pick, from, sampler.next2D()};
    sampler.skip();
    return std::nullopt;
}

DirectSample sampleDirect(const World& world, const Vec3& from, const Vec3& normal,
                          Sampler& sampler) {
    const auto query = queryAbove(world, from, normal, sampler);
    return query ? sampleDirect(world, query->pick, from, query->u) : DirectSample();
}

void sampleDirect(const World& world, std::span<const LightQuery> queries,
                  std::span<DirectSample> samples) {
    SSS_ASSERT_LE(queries.size(), kMostDirect);
    std::array<bool, kMostDirect> isDone{};
    for (std::size_t first = 0; first < queries.size(); ++first) {
        if (isDone[first]) continue;
        // All that ask for the same light.
        const LightPicker::Pick& pick = queries[first].pick;
        InlineVector<std::size_t, kMostDirect> which;
        InlineVector<Vec3, kMostDirect> from;
        InlineVector<Vec2, kMostDirect> u;
        InlineVector<LightSample, kMostDirect> found;
        for (std::size_t k = first; k < queries.size(); ++k) {
            if (queries[k].pick.index != pick.index) continue;
            isDone[k] = true;
            which.add(k);
            from.add(queries[k].from);
            u.add(queries[k].u);
            found.add();
        }
        const Light& light = *world.lights()[pick.index];
        light.sampleTogether(from.span(), u.span(), found.span());
        for (std::size_t j = 0; j < which.size(); ++j)
            samples[which[j]] = directSample(light, pick.pmf, found[j]);
    }
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

Rgb radianceOfLightsAlong(const World& world, const Ray& ray, const ScatterOrigin& origin,
                          bool& isNear) {
    Rgb sum(0);
    isNear = false;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    forEachSeen(world, ray, kInfinity, origin, [&](const Rgb& radiance, float lightDistance) {
        sum += radiance;
        isNear = isNear || std::isfinite(lightDistance);
    });
    return sum;
}

Rgb radianceOfOpenLights(const World& world, const Ray& ray, const ScatterOrigin& origin,
                         std::uint64_t& rays) {
    bool isNear = false;
    const Rgb sum = radianceOfLightsAlong(world, ray, origin, isNear);
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
