#pragma once
#include "sss/base/sampler.h"
#include "sss/image/film.h"
#include "sss/integrate/body_optics.h"
#include "sss/integrate/bsdf.h"
#include "sss/integrate/exitance_source.h"
#include "sss/integrate/light_sampling.h"
#include "sss/integrate/look_through.h"
#include "sss/integrate/volume_passage.h"
#include "sss/world/world.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sss {

struct PathCounts {
    std::uint64_t cameraSamples = 0;
    std::uint64_t rays = 0;  ///< of all kinds
    std::uint64_t diffusionLookups = 0;
    std::uint64_t singleSamples = 0;
    std::uint64_t singleSkipped = 0;  ///< for want of light within reach
    std::uint64_t scatterings = 0;    ///< inside bodies, one by one (radiative transfer)
    std::uint64_t leaks = 0;          ///< times a path met its body's surface where none should be
    std::uint64_t lost = 0;           ///< paths that did not end
    std::uint64_t volumeStretches = 0;  ///< of paths, looked at for volumes; 0 without volumes

    void add(const PathCounts& other);
};

/// Path tracing with next-event estimation and multiple importance sampling. Translucent bodies
/// reflect, send out the exitance that a source says, and scatter singly; without a source (pass 1)
/// they stand in their diffuse limit. Volumes in space dim, glow and scatter once a path. Const and
/// thread-safe.
class PathTracer {
public:
    /// `optics` by body; `exitance` null for the diffuse limit, or what else `local` says. All
    /// outlive the tracer.
    PathTracer(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
               const ExitanceSource* exitance,
               Bsdf::BodyShading local = Bsdf::BodyShading::DiffuseLimit);

    /// The most rays that are traced together.
    static constexpr std::size_t kMostViews = 16;
    /// The camera's views along rays that lie close together, such as those of one pixel, each with
    /// its numbers, by layer: what the first surface sends out from within by multiple scattering,
    /// by single scattering, and everything else.
    void trace(std::span<const Ray> rays, std::span<Sampler> samplers, std::span<FilmSample> seen,
               PathCounts& counts) const;

    /// The view along one ray.
    FilmSample trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const {
        FilmSample seen;
        trace(std::span(&ray, 1), std::span(&sampler, 1), std::span(&seen, 1), counts);
        return seen;
    }

    /// Radiance that arrives along a ray: lights (weighted by `origin`), and surfaces as long as
    /// `bounces` allows (0 = lights and emitters only).
    Rgb incoming(const Ray& ray, const ScatterOrigin& origin, int bounces, Sampler& sampler,
                 PathCounts& counts) const {
        if (bounces <= 0 && !world_.hasUnseenLight())
            return radianceOfOpenLights(world_, ray, origin, counts.rays);
        return followed(ray, origin, bounces, sampler, counts);
    }

    /// An estimate of the radiance that leaves a body towards `wo` after one scattering inside it.
    Rgb singleScatteringAt(const SurfaceHit& hit, const Vec3& wo, const Vec3& normal,
                           Sampler& sampler, PathCounts& counts) const;

    /// Light that reaches a surface straight from a light and is scattered there, by light
    /// sampling, weighted against sampling the BSDF.
    Rgb directLight(const SurfaceHit& hit, const Bsdf& bsdf, Sampler& sampler,
                    PathCounts& counts) const;

private:
    /// Radiance by multiple scattering; `through`, if asked for, is the way that the line of sight
    /// takes through the body, where it does.
    Rgb diffusion(const SurfaceHit& hit, const Bsdf& bsdf, const Vec3& wo, Sampler& sampler,
                  PathCounts& counts, std::optional<LookThrough>* through = nullptr) const;
    /// What is seen at the end of that way.
    Rgb behind(const LookThrough& through, Sampler& sampler, PathCounts& counts) const;
    /// What arrives along a ray, through surfaces; `first` if what it hits is known.
    Rgb followed(Ray ray, ScatterOrigin origin, int bounces, Sampler& sampler, PathCounts& counts,
                 const Hit* first = nullptr) const;
    /// The way to a light.
    struct ShadowRay {
        Ray ray;
        int volume = -1;  ///< as in DirectSample
    };
    /// What a light sample brings to a surface if nothing stands on the way `shadow`, which is set
    /// unless that is zero.
    static Rgb openLight(const Bsdf& bsdf, const Vec3& from, const DirectSample& direct,
                         ShadowRay& shadow);
    /// What the camera sees. Made in place: copying what was just written stalls the processor.
    struct FirstSurface;
    /// A ray that goes on from there, and what its light is added to, times its weight.
    struct Onward {
        Ray ray;
        ScatterOrigin origin;
        int bounces;
        Rgb weight;
        Rgb* sum;
        Sampler* sampler;
    };
    /// Several views in the making, and the steps in which they are made: each traces its rays
    /// together.
    struct Views;
    void findSurfaces(Views& views, PathCounts& counts) const;
    void lightDirectly(Views& views, PathCounts& counts) const;
    /// Whether light that a body reflects is worth a shadow ray; weights it if that was by chance.
    bool isFollowed(const FirstSurface& surface, Views& views, Rgb& light) const;
    void scatterOnce(Views& views, PathCounts& counts) const;
    void reflect(Views& views) const;
    void follow(std::span<Onward> onwards, PathCounts& counts) const;
    /// The same where rays bring nothing but the light of lamps.
    void seeLamps(std::span<Onward> onwards, PathCounts& counts) const;
    /// What a view sees by reflection at its first surface.
    Rgb& reflectedBy(const FirstSurface& surface, Views& views) const;
    /// Whether a camera ray may meet a lamp before a surface.
    bool lampsMayShow() const;
    /// Puts volumes and lights between the camera and what is seen, which is `distance` away.
    void putInFront(const Ray& ray, float distance, Sampler& sampler, FilmSample& seen,
                    PathCounts& counts) const;
    VolumePassage throughVolumes(const PathStretch& stretch, int bounces, Sampler& sampler,
                                 PathCounts& counts) const;
    Bsdf bsdfAt(const SurfaceHit& hit, const Vec3& wo) const;
    /// Draws the next ray; false if the path ends.
    bool scatter(const SurfaceHit& hit, const Bsdf& bsdf, Sampler& sampler, Ray& ray,
                 ScatterOrigin& origin, Rgb& throughput) const;

    const World& world_;
    std::span<const std::unique_ptr<BodyOptics>> optics_;
    const ExitanceSource* exitance_;
    Bsdf::BodyShading shading_;
    bool lampsMayShow_;
};

}  // namespace sss
