#pragma once
#include "sss/integrate/field_exitance.h"
#include "sss/integrate/integrator_table.h"

namespace sss {

/// The two passes: diffusion by the cached point clouds, single scattering, path-traced surfaces.
class CachedIntegrator : public Integrator {
public:
    explicit CachedIntegrator(const IntegratorInput& input)
        : exitance_(input), tracer_(input.world, input.optics, &exitance_) {}
    FilmSample trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const override {
        return tracer_.trace(ray, sampler, counts);
    }
    void traceAll(std::span<const Ray> rays, std::span<Sampler> samplers,
                  std::span<FilmSample> seen, PathCounts& counts) const override {
        tracer_.trace(rays, samplers, seen, counts);
    }

private:
    FieldExitance exitance_;
    PathTracer tracer_;
};

}  // namespace sss
