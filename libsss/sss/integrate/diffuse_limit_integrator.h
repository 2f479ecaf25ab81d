#pragma once
#include "sss/integrate/integrator_table.h"

namespace sss {

/// The limit of short mean free paths [JMLH01 section 2.4]: light leaves a body where it entered,
/// by the total of its profile. No cache; what any diffusion has to beat.
class DiffuseLimitIntegrator : public Integrator {
public:
    explicit DiffuseLimitIntegrator(const IntegratorInput& input);
    FilmSample trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const override;

private:
    const World& world_;
    std::span<const std::unique_ptr<BodyOptics>> optics_;
    PathTracer tracer_;
};

}  // namespace sss
