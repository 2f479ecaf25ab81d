#pragma once
#include "sss/integrate/integrator_table.h"

namespace sss {

/// The two passes: diffusion by the cached point clouds, single scattering, path-traced surfaces.
class CachedIntegrator : public Integrator {
public:
    explicit CachedIntegrator(const IntegratorInput& input)
        : tracer_(input.world, input.optics, input.fields) {}
    FilmSample trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const override {
        return tracer_.trace(ray, sampler, counts);
    }

private:
    PathTracer tracer_;
};

}  // namespace sss
