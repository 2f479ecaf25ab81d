#include "sss/integrate/path_tracer.h"

#include "sss/base/assert.h"
#include "sss/integrate/arriving_light.h"
#include "sss/integrate/single_scatter.h"

#include <algorithm>
#include <array>
#include <optional>

namespace sss {
namespace {

// Paths longer than this are continued by chance.
constexpr int kRouletteDepth = 3;
// Share of the camera samples whose reflection is followed: this many times its weight, and at
// least so many.
constexpr float kReflectionEffort = 8.0f, kLeastReflectionShare = 0.35f;
// A direction drawn with less than this density (sr^-1) came from a diffuse or very rough lobe.
constexpr float kWideLobe = 1.0f;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

void PathCounts::add(const PathCounts& other) {
    cameraSamples += other.cameraSamples;
    rays += other.rays;
    diffusionLookups += other.diffusionLookups;
    singleSamples += other.singleSamples;
    scatterings += other.scatterings;
    leaks += other.leaks;
    lost += other.lost;
    volumeStretches += other.volumeStretches;
}

PathTracer::PathTracer(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                       std::span<const std::unique_ptr<BodyField>> fields)
    : world_(world), optics_(optics), fields_(fields) {}

Bsdf PathTracer::bsdfAt(const SurfaceHit& hit, const Vec3& wo) const {
    const BodyOptics* optics =
        hit.body >= 0 ? optics_[static_cast<std::size_t>(hit.body)].get() : nullptr;
    return Bsdf(world_, hit, wo, optics,
                fields_.empty() ? Bsdf::BodyShading::DiffuseLimit : Bsdf::BodyShading::Surface);
}

PathTracer::OpenLight PathTracer::openLight(const SurfaceHit& hit, const Bsdf& bsdf,
                                            Sampler& sampler) const {
    if (!bsdf.hasSmoothPart()) {
        sampler.skip(2);
        return {};
    }
    const Vec3 from = world_.leave(hit, bsdf.geometricNormal());
    const DirectSample direct = sampleDirect(world_, from, bsdf.geometricNormal(), sampler);
    if (!(direct.pdf > 0)) return {};
    const Rgb value = bsdf.evaluate(direct.direction);
    if (isZero(value)) return {};
    const float weight =
        direct.isDelta ? 1.0f : powerHeuristic(direct.pdf, bsdf.pdf(direct.direction));
    return {value * direct.radianceOverPdf * weight, shadowRay(from, direct), direct};
}

Rgb PathTracer::directLight(const SurfaceHit& hit, const Bsdf& bsdf, Sampler& sampler,
                            PathCounts& counts) const {
    const OpenLight light = openLight(hit, bsdf, sampler);
    return isZero(light.radiance) ? Rgb(0) : arriving(light, counts);
}

Rgb PathTracer::arriving(const OpenLight& light, PathCounts& counts) const {
    return light.radiance * arrivingShare(world_, light.shadow, light.sample, counts.rays);
}

VolumePassage PathTracer::throughVolumes(const PathStretch& stretch, int bounces, Sampler& sampler,
                                         PathCounts& counts) const {
    ++counts.volumeStretches;
    return passVolumes(
        world_, stretch, sampler,
        [&](const Ray& ray, const Vec3& from, float pdf) {
            return incoming(ray, {from, pdf, true}, std::min(bounces, 1), sampler, counts);
        },
        counts.rays);
}

void PathTracer::seeThroughVolumes(const PathStretch& stretch, Sampler& sampler, FilmSample& seen,
                                   PathCounts& counts) const {
    const VolumePassage passage =
        throughVolumes(stretch, world_.scene().quality.bounces, sampler, counts);
    seen.diffusion *= passage.transmittance;
    seen.single *= passage.transmittance;
    seen.surface = seen.surface * passage.transmittance + passage.radiance;
    seen.alpha = std::max(seen.alpha, 1 - meanComponent(passage.transmittance));
}

Rgb PathTracer::diffusion(const SurfaceHit& hit, const Bsdf& bsdf, PathCounts& counts) const {
    if (hit.body < 0 || fields_.empty()) return Rgb(0);
    const auto body = static_cast<std::size_t>(hit.body);
    const BodyOptics& optics = *optics_[body];
    if (!optics.material.multipleScattering) return Rgb(0);
    ++counts.diffusionLookups;
    return fields_[body]->exitance(hit.bodyFace, hit.barycentrics) *
           optics.radiancePerExitance(bsdf.cosOutgoing());
}

Rgb PathTracer::single(const SurfaceHit& hit, const Bsdf& bsdf, const Vec3& wo, int bounces,
                       Sampler& sampler, PathCounts& counts) const {
    SingleScatterCounts spent;
    const Rgb radiance = singleScattering(
        world_, *optics_[static_cast<std::size_t>(hit.body)], hit, wo, bsdf.shadingNormal(),
        sampler,
        [&](const Ray& ray, const Vec3& from, float pdf) {
            return incoming(ray, {from, pdf}, std::min(bounces, 1), sampler, counts);
        },
        spent);
    counts.singleSamples += spent.samples;
    counts.rays += spent.rays;
    return radiance;
}

bool PathTracer::scatter(const SurfaceHit& hit, const Bsdf& bsdf, Sampler& sampler, Ray& ray,
                         ScatterOrigin& origin, Rgb& throughput) const {
    const Bsdf::Sample next = bsdf.sample(sampler.next2D());
    if (!(next.pdf > 0) || isZero(next.weight)) return false;
    throughput *= next.weight;
    ray = Ray{};
    ray.origin = world_.leave(hit, bsdf.geometricNormal());
    ray.direction = next.wi;
    origin = next.isDelta ? ScatterOrigin{} : ScatterOrigin{ray.origin, next.pdf};
    return true;
}

Rgb PathTracer::incoming(Ray ray, ScatterOrigin origin, int bounces, Sampler& sampler,
                         PathCounts& counts) const {
    Rgb sum(0), throughput(1);
    const bool afterVolume = origin.afterVolume;
    bool isWide = false;
    for (int depth = 0;; ++depth) {
        if (depth >= bounces && !world_.hasEmitters() && !world_.hasVolumes())
            return sum + throughput * radianceOfOpenLights(world_, ray, origin, counts.rays);
        Hit found;
        ++counts.rays;
        const bool isHit = world_.rays().intersect(ray, found);
        const float distance = isHit ? found.t : kInfinity;
        sum += throughput * radianceOfLights(world_, ray, distance, origin);
        if (world_.hasVolumes()) {
            origin.afterVolume = afterVolume;
            const VolumePassage passage =
                throughVolumes({ray, distance, origin}, bounces, sampler, counts);
            sum += throughput * passage.radiance;
            throughput *= passage.transmittance;
        }
        if (!isHit) return sum;
        const SurfaceHit hit = world_.surfaceAt(found);
        sum += throughput * radianceOfEmitter(world_, ray, hit, origin);
        if (depth >= bounces) return sum;
        const Vec3 wo = -ray.direction;
        Bsdf bsdf = bsdfAt(hit, wo);
        isWide = isWide || origin.pdf < kWideLobe;
        if (isWide) bsdf.roughenForIndirect();
        // Seen at second hand, all that comes from within is taken from the diffusion, unscaled:
        // the profile's total has the light scattered once in it.
        sum +=
            throughput * (directLight(hit, bsdf, sampler, counts) + diffusion(hit, bsdf, counts));
        if (!scatter(hit, bsdf, sampler, ray, origin, throughput)) return sum;
        if (depth + 1 >= kRouletteDepth) {
            const float survival = std::min(0.95f, maxComponent(throughput));
            if (!(sampler.next1D() < survival)) return sum;
            throughput /= survival;
        } else {
            sampler.skip();
        }
    }
}

FilmSample PathTracer::shade(const FirstSurface& surface, const Ray& ray, Sampler& sampler,
                             PathCounts& counts) const {
    const SurfaceHit& hit = surface.hit;
    const Bsdf& bsdf = surface.bsdf;
    const int bounces = world_.scene().quality.bounces;
    FilmSample seen;
    seen.alpha = 1;
    seen.depth = hit.distance * glm::dot(ray.direction, world_.camera().forward());
    seen.normal = bsdf.shadingNormal();
    seen.albedo = bsdf.albedo();
    // In the diffuse limit, what comes from within is what the surface reflects.
    Rgb& reflected = hit.body >= 0 && fields_.empty() ? seen.diffusion : seen.surface;
    reflected = radianceOfEmitter(world_, ray, hit, {}) + surface.direct;
    if (hit.body >= 0 && !fields_.empty()) {
        const BodyOptics& optics = *optics_[static_cast<std::size_t>(hit.body)];
        seen.diffusion = diffusion(hit, bsdf, counts) * optics.multipleScale;
        if (optics.material.singleScattering && sampler.next1D() < optics.singleProbability)
            seen.single = single(hit, bsdf, -ray.direction, bounces, sampler, counts) /
                          optics.singleProbability;
    }
    Ray next;
    ScatterOrigin origin;
    Rgb throughput(1);
    if (!scatter(hit, bsdf, sampler, next, origin, throughput)) return seen;
    // A dielectric reflects 4 % of what it sees: not every sample needs to look.
    const float survival =
        std::clamp(kReflectionEffort * maxComponent(throughput), kLeastReflectionShare, 1.0f);
    if (sampler.next1D() < survival)
        reflected += throughput / survival * incoming(next, origin, bounces, sampler, counts);
    return seen;
}

void PathTracer::trace(std::span<const Ray> rays, std::span<Sampler> samplers,
                       std::span<FilmSample> seen, PathCounts& counts) const {
    SSS_ASSERT_LE(rays.size(), kMostViews);
    std::array<Hit, kMostViews> found;
    world_.rays().intersectTogether(rays, found);
    counts.cameraSamples += rays.size();
    counts.rays += rays.size();

    std::array<std::optional<FirstSurface>, kMostViews> surfaces;
    std::array<Ray, kMostViews> shadows;
    std::array<FirstSurface*, kMostViews> lit;  // by shadow ray
    std::size_t shadowCount = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (found[i].geometry == kNoGeometry) continue;
        const SurfaceHit hit = world_.surfaceAt(found[i]);
        FirstSurface& surface =
            surfaces[i].emplace(FirstSurface{hit, bsdfAt(hit, -rays[i].direction)});
        const OpenLight light = openLight(hit, surface.bsdf, samplers[i]);
        if (isZero(light.radiance)) continue;
        if (world_.hasVolumes()) {
            surface.direct = arriving(light, counts);
            continue;
        }
        surface.direct = light.radiance;
        shadows[shadowCount] = light.shadow;
        lit[shadowCount++] = &surface;
    }
    const std::uint64_t occluded =
        world_.rays().occludedTogether(std::span(shadows).first(shadowCount));
    counts.rays += shadowCount;
    for (std::size_t k = 0; k < shadowCount; ++k)
        if (occluded >> k & 1) lit[k]->direct = Rgb(0);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const float distance = surfaces[i] ? surfaces[i]->hit.distance : kInfinity;
        seen[i] = surfaces[i] ? shade(*surfaces[i], rays[i], samplers[i], counts) : FilmSample{};
        if (world_.hasVolumes())
            seeThroughVolumes({rays[i], distance, {}}, samplers[i], seen[i], counts);
        seen[i].surface += radianceOfLights(world_, rays[i], distance, {});
    }
}

}  // namespace sss
