#include "sss/integrate/bssrdf_exitance.h"

namespace sss {

BssrdfExitance::BssrdfExitance(const World& world,
                               std::span<const std::unique_ptr<BodyOptics>> optics)
    : indirect_(world, optics, nullptr) {
    bodies_.reserve(optics.size());
    for (std::size_t b = 0; b < optics.size(); ++b)
        bodies_.push_back({EntrySampler(world, static_cast<int>(b), *optics[b]),
                           IrradianceEstimator(world, indirect_, optics[b]->eta)});
}

Rgb BssrdfExitance::exitance(const SurfaceHit& hit, const Vec3&, Sampler& sampler,
                             PathCounts& counts) const {
    Sampler side = sampler.branch();
    const BodySource& body = bodies_[static_cast<std::size_t>(hit.body)];
    if (body.entries.isEmpty()) return Rgb(0);
    counts.rays += EntrySampler::kProbes;
    const EntryPlace entry = body.entries.sample(hit, side);
    if (isZero(entry.weight)) return Rgb(0);
    return entry.weight * body.irradiance.estimate(entry.hit, side, counts);
}

}  // namespace sss
