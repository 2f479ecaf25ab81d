#pragma once
#include "sss/integrate/integrator_table.h"

namespace sss {

/// The limit of short mean free paths, f = f^(1) + F_t F_t R_d / pi [JMLH01 section 2.4]: light
/// leaves a body where it entered, after one scattering as by a half-space, and after more of them
/// by the total of its profile, scaled as the material's energy convention says. Gloss lies on top.
/// No cache; what any diffusion has to beat.
class DiffuseLimitIntegrator : public Integrator {
public:
    explicit DiffuseLimitIntegrator(const IntegratorInput& input);
    FilmSample trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const override;

private:
    /// Light from everywhere, reflected by one of the body's parts.
    Rgb reflected(const SurfaceHit& hit, const Bsdf& bsdf, Sampler& sampler,
                  PathCounts& counts) const;
    const World& world_;
    std::span<const std::unique_ptr<BodyOptics>> optics_;
    PathTracer tracer_;
};

/// Bodies as plain Lambertian surfaces that reflect the total of their profile: no Fresnel, no
/// gloss, nothing by direction.
class LambertianIntegrator : public Integrator {
public:
    explicit LambertianIntegrator(const IntegratorInput& input)
        : tracer_(input.world, input.optics, nullptr, Bsdf::BodyShading::Lambertian) {}
    FilmSample trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const override {
        return tracer_.trace(ray, sampler, counts);
    }

private:
    PathTracer tracer_;
};

}  // namespace sss
