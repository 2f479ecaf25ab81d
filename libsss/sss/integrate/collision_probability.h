#pragma once
#include "sss/cloud/point_cloud.h"
#include "sss/shape/diffusion_constants.h"
#include "sss/world/world.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

struct CollisionCounts {
    std::uint64_t rays = 0;
};

/// First-flight collision probability at a body's points (body space), by channel: of diffuse
/// light that enters there, the share that collides before it leaves, in the reduced sense. By
/// reciprocity it is also the share of lines of sight into the body, on the mean over all that
/// leave at the point, that ends within: a body of even fluence sends out so much of what it would
/// if it went on behind for ever. With absorption fluence falls off along them, and what lies far
/// counts for less (DiffusionConstants::fading). 1 where the body is thick, and for channels that
/// do not scatter; kLeastCollided at least. RMS error below 0.01. Deterministic; parallel.
///
/// The term is the reactor physicists' [e.g. Case, de Hoffmann and Placzek 1953], here with Fresnel
/// reflection at the boundary.
std::vector<Rgb> collisionProbabilities(const World& world, int body,
                                        std::span<const SurfacePoint> points,
                                        const DiffusionConstants& medium, CollisionCounts& counts);

/// Parts so thin that next to nothing collides in them are bounded, not right.
inline constexpr float kLeastCollided = 0.02f;

}  // namespace sss
