#include "sss/integrate/field_exitance.h"

namespace sss {

FieldExitance::FieldExitance(const IntegratorInput& input)
    : input_(input), indirect_(input.world, input.optics, nullptr) {
    for (const auto& optics : input.optics)
        irradiance_.emplace_back(input.world, indirect_, optics->eta);
    for (const Body& body : input.world.bodies())
        bodyFromWorld_.emplace_back(body.worldFromBody.inverse().rotation);
}

Rgb FieldExitance::inLimit(const SurfaceHit& hit, Sampler& sampler, PathCounts& counts) const {
    const auto body = static_cast<std::size_t>(hit.body);
    Sampler side = sampler.branch();
    return input_.optics[body]->diffuseAlbedo * irradiance_[body].estimate(hit, side, counts);
}

}  // namespace sss
