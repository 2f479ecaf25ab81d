// What the camera sees: many views at once, step by step, so that rays are traced together.
#include "sss/base/assert.h"
#include "sss/base/inline_vector.h"
#include "sss/integrate/arriving_light.h"
#include "sss/integrate/first_hit.h"
#include "sss/integrate/path_tracer.h"
#include "sss/integrate/single_scatter.h"
#include "sss/optics/fresnel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sss {
namespace {

// Share of the camera samples whose reflection is followed: this many times its weight, and at
// least so many.
constexpr float kReflectionEffort = 6.0f, kLeastReflectionShare = 0.25f;
// Light that a polished body reflects straight from a lamp is followed by chance where it is less
// than this share of what the body sends out from within: its noise is then a fraction of that.
constexpr float kFaintReflection = 0.02f;
// The dimension of the number that decides whether a faint reflection is followed: far beyond those
// that a path takes in order.
constexpr std::uint32_t kFollowingDimension = 1u << 20;

// By how much a sample of number `index` counts, of the `all` of a pixel, if only a share of them
// is taken; 0 if it is not. The first of them are, as they are stratified among themselves.
float weightInShare(float share, std::uint32_t index, std::uint32_t all) {
    const auto some = static_cast<std::uint32_t>(std::ceil(share * static_cast<float>(all)));
    return index % all < some ? static_cast<float>(all) / static_cast<float>(some) : 0.0f;
}

static_assert(PathTracer::kMostViews <= std::min(kMostSingle, kMostDirect));
template <typename T>
using ViewList = InlineVector<T, PathTracer::kMostViews>;

}  // namespace

struct PathTracer::FirstSurface {
    FirstSurface(const PathTracer& tracer, const Hit& found, const Vec3& wo, std::size_t number)
        : hit(tracer.world_.surfaceAt(found)), bsdf(tracer.bsdfAt(hit, wo)), view(number) {}
    SurfaceHit hit;
    Bsdf bsdf;
    std::size_t view;
};

struct PathTracer::Views {
    std::span<const Ray> rays;
    std::span<Sampler> samplers;
    std::span<FilmSample> seen;
    ViewList<FirstSurface> surfaces;
    ViewList<SingleQuery> queries;
    InlineVector<Onward, 2 * kMostViews> onwards;
};

void PathTracer::trace(std::span<const Ray> rays, std::span<Sampler> samplers,
                       std::span<FilmSample> seen, PathCounts& counts) const {
    SSS_ASSERT_LE(rays.size(), kMostViews);
    Views views{rays, samplers, seen, {}, {}, {}};
    counts.cameraSamples += rays.size();
    findSurfaces(views, counts);
    lightDirectly(views, counts);
    scatterOnce(views, counts);
    reflect(views);
    follow(views.onwards.span(), counts);
    for (const FirstSurface& surface : views.surfaces) {
        const std::size_t i = surface.view;
        putInFront(rays[i], surface.hit.distance, samplers[i], seen[i], counts);
    }
}

// The surfaces that the views meet first, and what these send out by multiple scattering.
void PathTracer::findSurfaces(Views& views, PathCounts& counts) const {
    ViewList<Hit> found;
    for (std::size_t i = 0; i < views.rays.size(); ++i) found.add();
    world_.rays().intersectTogether(views.rays, RayScene::Together::Parallel, found.span());
    counts.rays += views.rays.size();
    for (std::size_t i = 0; i < views.rays.size(); ++i) {
        const Ray& ray = views.rays[i];
        FilmSample& seen = views.seen[i];
        if (found[i].geometry == kNoGeometry) {
            seen = {};
            putInFront(ray, std::numeric_limits<float>::infinity(), views.samplers[i], seen,
                       counts);
            continue;
        }
        const FirstSurface& surface = views.surfaces.add(*this, found[i], -ray.direction, i);
        const SurfaceHit& hit = surface.hit;
        seen.diffusion = seen.single = Rgb(0);
        describeFirstHit(world_, ray, hit, surface.bsdf, seen);
        seen.surface = radianceOfEmitter(world_, ray, hit, {});
        if (hit.body < 0 || !exitance_) continue;
        const BodyOptics& optics = *optics_[static_cast<std::size_t>(hit.body)];
        std::optional<LookThrough> through;
        seen.diffusion =
            diffusion(hit, surface.bsdf, -ray.direction, views.samplers[i], counts, &through) *
            optics.multipleScale;
        if (through) seen.surface += behind(*through, views.samplers[i], counts);
    }
}

// In the diffuse limit, what comes from within is what the surface reflects.
Rgb& PathTracer::reflectedBy(const FirstSurface& surface, Views& views) const {
    FilmSample& seen = views.seen[surface.view];
    return surface.hit.body >= 0 && !exitance_ ? seen.diffusion : seen.surface;
}

void PathTracer::lightDirectly(Views& views, PathCounts& counts) const {
    struct Lit {
        Rgb light;
        Rgb* sum;
    };
    ViewList<LightQuery> queries;
    ViewList<const FirstSurface*> asking;  // by query
    for (const FirstSurface& surface : views.surfaces) {
        if (!surface.bsdf.hasSmoothPart()) continue;
        const Vec3& normal = surface.bsdf.geometricNormal();
        const auto query = queryAbove(world_, world_.leave(surface.hit, normal), normal,
                                      views.samplers[surface.view]);
        if (!query) continue;
        queries.add(*query);
        asking.add(&surface);
    }
    std::array<DirectSample, kMostViews> samples;
    sampleDirect(world_, queries.span(), samples);

    ViewList<Ray> shadows;
    ViewList<Lit> lit;  // by shadow ray
    for (std::size_t k = 0; k < queries.size(); ++k) {
        const FirstSurface& surface = *asking[k];
        ShadowRay shadow;
        Rgb light = openLight(surface.bsdf, queries[k].from, samples[k], shadow);
        if (isZero(light) || !isFollowed(surface, views, light)) continue;
        Rgb& sum = reflectedBy(surface, views);
        if (world_.hasVolumes()) {
            sum += light * arrivingShare(world_, shadow.ray, shadow.volume, counts.rays);
            continue;
        }
        shadows.add(shadow.ray);
        lit.add(Lit{light, &sum});
    }
    std::array<bool, kMostViews> occluded;
    world_.rays().occludedTogether(shadows.span(), RayScene::Together::Parted, occluded);
    counts.rays += shadows.size();
    for (std::size_t k = 0; k < lit.size(); ++k)
        if (!occluded[k]) *lit[k].sum += lit[k].light;
}

bool PathTracer::isFollowed(const FirstSurface& surface, Views& views, Rgb& light) const {
    if (surface.hit.body < 0 || !exitance_) return true;
    const float faint = kFaintReflection * meanComponent(views.seen[surface.view].diffusion);
    const float brightness = meanComponent(light);
    if (brightness >= faint) return true;
    // A number that nothing else takes, as most samples need none.
    Sampler side = views.samplers[surface.view];
    side.skip(kFollowingDimension);
    if (!(side.next1D() * faint < brightness)) return false;
    light *= faint / brightness;
    return true;
}

void PathTracer::scatterOnce(Views& views, PathCounts& counts) const {
    struct Wanted {
        FilmSample* seen;
        float weight;
    };
    ViewList<Wanted> wanted;  // by query
    const auto all = static_cast<std::uint32_t>(world_.scene().film.samples);
    for (const FirstSurface& surface : views.surfaces) {
        const SurfaceHit& hit = surface.hit;
        if (hit.body < 0 || !exitance_) continue;
        const BodyOptics& optics = *optics_[static_cast<std::size_t>(hit.body)];
        if (!optics.material.singleScattering) continue;
        Sampler& sampler = views.samplers[surface.view];
        Sampler side = sampler.branch();
        const float weight = weightInShare(optics.singleProbability, sampler.index(), all);
        if (weight == 0) continue;
        if (!mayScatterOnce(world_, optics, hit.position)) {
            ++counts.singleSkipped;
            continue;
        }
        views.queries.add(SingleQuery{&optics, &hit, -views.rays[surface.view].direction,
                                      surface.bsdf.shadingNormal(), side});
        wanted.add(Wanted{&views.seen[surface.view], weight});
    }
    ViewList<SingleFound> found;
    for (std::size_t k = 0; k < wanted.size(); ++k) found.add();
    SingleScatterCounts spent;
    singleScattering(world_, views.queries.span(), found.span(), spent);
    counts.singleSamples += spent.samples;
    counts.rays += spent.rays;
    const int bounces = std::min(world_.scene().quality.bounces, 1);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        Rgb& sum = wanted[k].seen->single;
        sum = found[k].radiance * wanted[k].weight;
        if (isZero(found[k].weight)) continue;
        views.onwards.add(Onward{found[k].ray, found[k].origin, bounces,
                                 found[k].weight * wanted[k].weight, &sum,
                                 &views.queries[k].sampler});
    }
}

void PathTracer::reflect(Views& views) const {
    const int bounces = world_.scene().quality.bounces;
    const auto all = static_cast<std::uint32_t>(world_.scene().film.samples);
    for (const FirstSurface& surface : views.surfaces) {
        // A dielectric reflects 4 % of what it sees: not every sample needs to look.
        float share = 1;
        if (surface.hit.body >= 0 && exitance_) {
            const BodyOptics& optics = *optics_[static_cast<std::size_t>(surface.hit.body)];
            share = std::clamp(
                kReflectionEffort * fresnelReflectance(surface.bsdf.cosOutgoing(), optics.eta),
                kLeastReflectionShare, 1.0f);
        }
        Sampler& sampler = views.samplers[surface.view];
        const float weight = weightInShare(share, sampler.index(), all);
        if (weight == 0) continue;
        Rgb throughput(weight);
        Ray ray;
        ScatterOrigin origin;
        if (!scatter(surface.hit, surface.bsdf, sampler, ray, origin, throughput)) continue;
        views.onwards.add(
            Onward{ray, origin, bounces, throughput, &reflectedBy(surface, views), &sampler});
    }
}

void PathTracer::follow(std::span<Onward> onwards, PathCounts& counts) const {
    if (world_.scene().quality.bounces <= 0 && !world_.hasUnseenLight())
        return seeLamps(onwards, counts);
    InlineVector<Ray, 2 * kMostViews> rays;
    InlineVector<Hit, 2 * kMostViews> found;
    for (const Onward& onward : onwards) {
        rays.add(onward.ray);
        found.add();
    }
    world_.rays().intersectTogether(rays.span(), RayScene::Together::Parted, found.span());
    counts.rays += rays.size();
    for (std::size_t k = 0; k < onwards.size(); ++k) {
        const Onward& onward = onwards[k];
        *onward.sum += onward.weight * followed(onward.ray, onward.origin, onward.bounces,
                                                *onward.sampler, counts, &found[k]);
    }
}

void PathTracer::seeLamps(std::span<Onward> onwards, PathCounts& counts) const {
    InlineVector<Ray, 2 * kMostViews> rays;
    InlineVector<Onward*, 2 * kMostViews> lit;  // by ray
    for (Onward& onward : onwards) {
        bool isNear = false;
        const Rgb light = radianceOfLightsAlong(world_, onward.ray, onward.origin, isNear);
        if (isZero(light)) continue;
        if (isNear) {
            *onward.sum += onward.weight *
                           radianceOfOpenLights(world_, onward.ray, onward.origin, counts.rays);
            continue;
        }
        onward.weight *= light;
        rays.add(onward.ray);
        lit.add(&onward);
    }
    std::array<bool, 2 * kMostViews> occluded;
    world_.rays().occludedTogether(rays.span(), RayScene::Together::Parted, occluded);
    counts.rays += rays.size();
    for (std::size_t k = 0; k < lit.size(); ++k)
        if (!occluded[k]) *lit[k]->sum += lit[k]->weight;
}

}  // namespace sss
