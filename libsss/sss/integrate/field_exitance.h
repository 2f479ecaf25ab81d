#pragma once
#include "sss/integrate/exitance_source.h"
#include "sss/integrate/integrator_table.h"
#include "sss/integrate/irradiance_estimator.h"

#include <memory>
#include <span>
#include <vector>

namespace sss {

/// Exitance as pass 1 left it; of bodies without a field, which are in their diffuse limit, the
/// light that enters at the place itself, by chance, times what they send back.
class FieldExitance : public ExitanceSource {
public:
    /// All of the input outlives the source.
    explicit FieldExitance(const IntegratorInput& input);
    FieldExitance(const FieldExitance&) = delete;
    FieldExitance& operator=(const FieldExitance&) = delete;
    Rgb exitance(const SurfaceHit& hit, Sampler& sampler, PathCounts& counts) const override {
        const auto body = static_cast<std::size_t>(hit.body);
        return input_.fields[body] ? input_.fields[body]->exitance(hit.bodyFace, hit.barycentrics)
                                   : inLimit(hit, sampler, counts);
    }

private:
    Rgb inLimit(const SurfaceHit& hit, Sampler& sampler, PathCounts& counts) const;

    IntegratorInput input_;
    PathTracer indirect_;                          ///< bodies in their diffuse limit, as in pass 1
    std::vector<IrradianceEstimator> irradiance_;  ///< by body
};

}  // namespace sss
