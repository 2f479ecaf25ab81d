#include "sss/integrate/path_tracer.h"

#include "sss/image/filter.h"
#include "sss/integrate/arriving_light.h"
#include "sss/integrate/single_scatter.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

// Paths longer than this are continued by chance.
constexpr int kRouletteDepth = 3;
// Before that, this many times a path's weight is the chance that it goes on.
constexpr float kEffort = 6.0f;
// A direction drawn with less than this density (sr^-1) came from a diffuse or very rough lobe.
constexpr float kWideLobe = 1.0f;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

void PathCounts::add(const PathCounts& other) {
    cameraSamples += other.cameraSamples;
    rays += other.rays;
    diffusionLookups += other.diffusionLookups;
    singleSamples += other.singleSamples;
    singleSkipped += other.singleSkipped;
    scatterings += other.scatterings;
    leaks += other.leaks;
    lost += other.lost;
    volumeStretches += other.volumeStretches;
}

PathTracer::PathTracer(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                       const ExitanceSource* exitance, Bsdf::BodyShading local)
    : world_(world),
      optics_(optics),
      exitance_(exitance),
      shading_(exitance ? Bsdf::BodyShading::Surface : local),
      lampsMayShow_(lampsMayShow()) {}

bool PathTracer::lampsMayShow() const {
    const FilmSettings& film = world_.scene().film;
    const Vec2 reach(
        static_cast<float>(PixelFilter(film.filter, film.filterRadiusPixels).radiusPixels()));
    return std::ranges::any_of(world_.visibleLights(), [&](const World::VisibleLight& visible) {
        if (visible.isInfinite) return false;
        const Camera::Window window = world_.camera().windowOf(visible.light->visibleBounds());
        return glm::all(glm::lessThanEqual(window.lo, Vec2(film.width, film.height) + reach)) &&
               glm::all(glm::greaterThanEqual(window.hi, -reach));
    });
}

Bsdf PathTracer::bsdfAt(const SurfaceHit& hit, const Vec3& wo) const {
    const BodyOptics* optics =
        hit.body >= 0 ? optics_[static_cast<std::size_t>(hit.body)].get() : nullptr;
    return Bsdf(world_, hit, wo, optics, shading_);
}

Rgb PathTracer::openLight(const Bsdf& bsdf, const Vec3& from, const DirectSample& direct,
                          ShadowRay& shadow) {
    if (!(direct.pdf > 0)) return Rgb(0);
    const auto [value, pdf] = bsdf.evaluate(direct.direction);
    if (isZero(value)) return Rgb(0);
    const float weight = direct.isDelta ? 1.0f : powerHeuristic(direct.pdf, pdf);
    shadow = {shadowRay(from, direct), direct.volume};
    return value * direct.radianceOverPdf * weight;
}

Rgb PathTracer::directLight(const SurfaceHit& hit, const Bsdf& bsdf, Sampler& sampler,
                            PathCounts& counts) const {
    if (!bsdf.hasSmoothPart()) {
        sampler.skip(2);
        return Rgb(0);
    }
    const Vec3 from = world_.leave(hit, bsdf.geometricNormal());
    ShadowRay shadow;
    const Rgb light =
        openLight(bsdf, from, sampleDirect(world_, from, bsdf.geometricNormal(), sampler), shadow);
    if (isZero(light)) return Rgb(0);
    return light * arrivingShare(world_, shadow.ray, shadow.volume, counts.rays);
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

void PathTracer::putInFront(const Ray& ray, float distance, Sampler& sampler, FilmSample& seen,
                            PathCounts& counts) const {
    if (world_.hasVolumes()) {
        const VolumePassage passage =
            throughVolumes({ray, distance, {}}, world_.scene().quality.bounces, sampler, counts);
        seen.diffusion *= passage.transmittance;
        seen.single *= passage.transmittance;
        seen.surface = seen.surface * passage.transmittance + passage.radiance;
        seen.alpha = std::max(seen.alpha, 1 - meanComponent(passage.transmittance));
    }
    if (lampsMayShow_ || !std::isfinite(distance))
        seen.surface += radianceOfLights(world_, ray, distance, {});
}

Rgb PathTracer::diffusion(const SurfaceHit& hit, const Bsdf& bsdf, const Vec3& wo, Sampler& sampler,
                          PathCounts& counts, std::optional<LookThrough>* through) const {
    if (hit.body < 0 || !exitance_) return Rgb(0);
    const BodyOptics& optics = *optics_[static_cast<std::size_t>(hit.body)];
    Rgb radiance(0);
    if (optics.material.multipleScattering) {
        ++counts.diffusionLookups;
        radiance = exitance_->exitance(hit, wo, sampler, counts) *
                   optics.radiancePerExitance(bsdf.cosOutgoing());
    }
    if (!optics.seesThrough) return radiance;
    Sampler side = sampler.branch();
    const std::optional<LookThrough> way = lookThrough(world_, optics, hit, wo, side, counts.rays);
    if (through) *through = way;
    return way ? radiance * way->shown : radiance;
}

Rgb PathTracer::singleScatteringAt(const SurfaceHit& hit, const Vec3& wo, const Vec3& normal,
                                   Sampler& sampler, PathCounts& counts) const {
    const BodyOptics& optics = *optics_[static_cast<std::size_t>(hit.body)];
    if (!mayScatterOnce(world_, optics, hit.position)) {
        ++counts.singleSkipped;
        return Rgb(0);
    }
    SingleScatterCounts spent;
    const int bounces = std::min(world_.scene().quality.bounces, 1);
    const Rgb radiance = singleScattering(
        world_, optics, hit, wo, normal, sampler,
        [&](const Ray& ray, const Vec3& from, float pdf) {
            return incoming(ray, {from, pdf}, bounces, sampler, counts);
        },
        spent);
    counts.singleSamples += spent.samples;
    counts.rays += spent.rays;
    return radiance;
}

Rgb PathTracer::behind(const LookThrough& through, Sampler& sampler, PathCounts& counts) const {
    Sampler side = sampler.branch();
    const int bounces = std::max(1, world_.scene().quality.bounces);
    return through.weight * incoming(through.beyond, {}, bounces, side, counts);
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

Rgb PathTracer::followed(Ray ray, ScatterOrigin origin, int bounces, Sampler& sampler,
                         PathCounts& counts, const Hit* first) const {
    Rgb sum(0), throughput(1);
    const bool afterVolume = origin.afterVolume;
    bool isWide = false;
    for (int depth = 0;; ++depth) {
        if (depth >= bounces && !world_.hasUnseenLight())
            return sum + throughput * radianceOfOpenLights(world_, ray, origin, counts.rays);
        Hit found;
        bool isHit;
        if (depth == 0 && first) {
            found = *first;
            isHit = found.geometry != kNoGeometry;
        } else {
            ++counts.rays;
            isHit = world_.rays().intersect(ray, found);
        }
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
        sum += throughput * directLight(hit, bsdf, sampler, counts);
        // Seen at second hand, all that comes from within is taken from the diffusion: the
        // profile's total has the light scattered once in it.
        if (hit.body >= 0)
            sum += throughput * diffusion(hit, bsdf, wo, sampler, counts) *
                   optics_[static_cast<std::size_t>(hit.body)]->indirectScale;
        if (!scatter(hit, bsdf, sampler, ray, origin, throughput)) return sum;
        // At first only what is faint is continued by chance: what polish reflects once more.
        const float most = maxComponent(throughput);
        const float survival =
            depth + 1 >= kRouletteDepth ? std::min(0.95f, most) : std::min(1.0f, kEffort * most);
        if (survival >= 1) {
            sampler.skip();
            continue;
        }
        if (!(sampler.next1D() < survival)) return sum;
        throughput /= survival;
    }
}

}  // namespace sss
