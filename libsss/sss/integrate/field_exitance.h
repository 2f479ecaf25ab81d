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
    Rgb exitance(const SurfaceHit& hit, const Vec3& wo, Sampler& sampler,
                 PathCounts& counts) const override {
        const auto body = static_cast<std::size_t>(hit.body);
        if (!input_.fields[body]) return inLimit(hit, sampler, counts);
        return input_.fields[body]->exitance(hit.bodyFace, hit.barycentrics,
                                             Vec3(bodyFromWorld_[body] * DVec3(wo)));
    }

private:
    Rgb inLimit(const SurfaceHit& hit, Sampler& sampler, PathCounts& counts) const;

    IntegratorInput input_;
    PathTracer indirect_;                          ///< bodies in their diffuse limit, as in pass 1
    std::vector<IrradianceEstimator> irradiance_;  ///< by body
    std::vector<DMat3> bodyFromWorld_;             ///< by body, for directions
};

}  // namespace sss
