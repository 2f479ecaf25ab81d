#pragma once
#include "sss/integrate/bssrdf_exitance.h"
#include "sss/integrate/integrator_table.h"

namespace sss {

/// Path tracing with the BSSRDF, sample by sample [Koutajoki 2002, "BSSRDF (Bidirectional Surface
/// Scattering Distribution Function)", section 4]: a place of entry near the place seen, one shadow
/// ray and one indirect ray from there, and single scattering along the refracted ray. No pass 1,
/// no cache; the model of the cached integrator without its tolerance: what that one tends to.
///
/// The paper's Eqs. 16 to 18 do not integrate to what they should: here light is divided by the
/// density of its place of entry (EntrySampler) and looked for from that place, not from the one
/// seen; for single scattering see single_scatter.h.
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
