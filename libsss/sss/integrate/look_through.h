#pragma once
#include "sss/base/sampler.h"
#include "sss/integrate/body_optics.h"
#include "sss/world/world.h"

#include <cstdint>
#include <optional>

namespace sss {

/// What is seen through a body by light that goes straight: where the line of sight leaves it, and
/// how much of what is there comes through.
struct LookThrough {
    Ray beyond;
    Rgb weight{0.0f};
    /// Of what the line of sight would show of the body if it ended within, the share that it
    /// shows (DiffusionConstants::fading).
    Rgb shown{0.0f};
};

/// Follows the line of sight from `wo` through `hit`, refracted at the boundary, reflected inside
/// or let out by chance as Fresnel says, thinned by exp(-sigma'_t s). The reduced extinction,
/// because diffusion on the shape counts what is scattered nearly straight on as not scattered
/// (placeBeamSources): light is counted once. Nothing if no light comes through. `rays` counts.
std::optional<LookThrough> lookThrough(const World& world, const BodyOptics& optics,
                                       const SurfaceHit& hit, const Vec3& wo, Sampler& sampler,
                                       std::uint64_t& rays);

}  // namespace sss
