#pragma once
#include "sss/integrate/bssrdf_exitance.h"
#include "sss/integrate/integrator_table.h"

namespace sss {

/// Monte Carlo path tracing with the BSSRDF, sample by sample [Koutajoki 2002, "BSSRDF
/// (Bidirectional Surface Scattering Distribution Function)", section 4, with its equations 16 to
/// 18 put right]: entry places around the place seen, one shadow ray from each, indirect light, and
/// single scattering along the refracted ray. No pass 1, no cache; the same model as the cached
/// integrator's and without its tolerance: what that one tends to.
class BssrdfIntegrator : public Integrator {
public:
    explicit BssrdfIntegrator(const IntegratorInput& input)
        : exitance_(input.world, input.optics), tracer_(input.world, input.optics, &exitance_) {}
    FilmSample trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const override {
        return tracer_.trace(ray, sampler, counts);
    }
    void traceAll(std::span<const Ray> rays, std::span<Sampler> samplers,
                  std::span<FilmSample> seen, PathCounts& counts) const override {
        tracer_.trace(rays, samplers, seen, counts);
    }

private:
    BssrdfExitance exitance_;
    PathTracer tracer_;
};

}  // namespace sss
