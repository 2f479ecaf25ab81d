#include "sss/integrate/diffuse_limit_integrator.h"

namespace sss {

DiffuseLimitIntegrator::DiffuseLimitIntegrator(const IntegratorInput& input)
    : world_(input.world), optics_(input.optics), tracer_(input.world, input.optics, {}) {}

Rgb DiffuseLimitIntegrator::reflected(const SurfaceHit& hit, const Bsdf& bsdf, Sampler& sampler,
                                      PathCounts& counts) const {
    const Rgb direct = tracer_.directLight(hit, bsdf, sampler, counts);
    const Bsdf::Sample next = bsdf.sample(sampler.next2D());
    if (!(next.pdf > 0)) return direct;
    Ray ray;
    ray.origin = world_.leave(hit, bsdf.geometricNormal());
    ray.direction = next.wi;
    const ScatterOrigin origin =
        next.isDelta ? ScatterOrigin{} : ScatterOrigin{ray.origin, next.pdf};
    return direct + next.weight * tracer_.incoming(ray, origin, world_.scene().quality.bounces,
                                                   sampler, counts);
}

FilmSample DiffuseLimitIntegrator::trace(const Ray& ray, Sampler& sampler,
                                         PathCounts& counts) const {
    FilmSample sample = tracer_.trace(ray, sampler, counts);
    Hit found;
    ++counts.rays;
    if (!world_.rays().intersect(ray, found)) return sample;
    const SurfaceHit hit = world_.surfaceAt(found);
    if (hit.body < 0) return sample;
    const BodyOptics& optics = *optics_[static_cast<std::size_t>(hit.body)];
    const Rgb seen =
        world_.hasVolumes() ? world_.volumesAlong(ray, found.t).transmittance() : Rgb(1);
    // The tracer shows a body as one diffuse surface of the profile's total.
    sample.diffusion *= optics.material.multipleScattering ? optics.multipleScale : Rgb(0);
    const auto part = [&](Bsdf::BodyShading shading) {
        const Bsdf bsdf(world_, hit, -ray.direction, &optics, shading);
        return seen * reflected(hit, bsdf, sampler, counts);
    };
    if (optics.material.singleScattering) sample.single = part(Bsdf::BodyShading::ScatteredOnce);
    sample.surface += part(Bsdf::BodyShading::Surface);
    return sample;
}

}  // namespace sss
