#include "sss/integrate/diffuse_limit_integrator.h"

namespace sss {

DiffuseLimitIntegrator::DiffuseLimitIntegrator(const IntegratorInput& input)
    : world_(input.world), optics_(input.optics), tracer_(input.world, input.optics, {}) {}

FilmSample DiffuseLimitIntegrator::trace(const Ray& ray, Sampler& sampler,
                                         PathCounts& counts) const {
    FilmSample sample = tracer_.trace(ray, sampler, counts);
    Hit found;
    ++counts.rays;
    if (!world_.rays().intersect(ray, found)) return sample;
    const SurfaceHit hit = world_.surfaceAt(found);
    if (hit.body < 0) return sample;
    // The tracer shows a body as one diffuse surface; its gloss lies on top.
    const BodyOptics& optics = *optics_[static_cast<std::size_t>(hit.body)];
    if (!optics.material.multipleScattering) sample.diffusion = Rgb(0);
    const Rgb seen =
        world_.hasVolumes() ? world_.volumesAlong(ray, found.t).transmittance() : Rgb(1);
    const Bsdf gloss(world_, hit, -ray.direction, &optics, Bsdf::BodyShading::Surface);
    sample.surface += seen * tracer_.directLight(hit, gloss, sampler, counts);
    const Bsdf::Sample next = gloss.sample(sampler.next2D());
    if (!(next.pdf > 0)) return sample;
    Ray reflected;
    reflected.origin = world_.leave(hit, gloss.geometricNormal());
    reflected.direction = next.wi;
    const ScatterOrigin origin =
        next.isDelta ? ScatterOrigin{} : ScatterOrigin{reflected.origin, next.pdf};
    sample.surface +=
        seen * next.weight *
        tracer_.incoming(reflected, origin, world_.scene().quality.bounces, sampler, counts);
    return sample;
}

}  // namespace sss
