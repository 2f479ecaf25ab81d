#pragma once
#include "sss/base/vec.h"

namespace sss {

/// What diffusion on a body's own shape says at one of its points, W m^-2.
struct SolvedExitance {
    Rgb correction{0.0f};  ///< to what the profile gives
    /// All that has scattered, once and more often, over `collided`: how it changes along the
    /// surface says which way light leans as it leaves.
    Rgb thickExitance{0.0f};
    /// Of lines of sight into the body, the share that ends within, on the mean over directions;
    /// 1 where the body is thick, or where nobody looks through it.
    Rgb collided{1.0f};
};

/// How far light leans that leaves: what its radiance gains, in units of the Lambertian radiance of
/// 1 W m^-2, by component of the unit vector that points at who looks.
struct ExitanceSlope {
    Rgb x{0.0f}, y{0.0f}, z{0.0f};

    Rgb along(const Vec3& towards) const { return x * towards.x + y * towards.y + z * towards.z; }
};
static_assert(sizeof(ExitanceSlope) == 3 * sizeof(Rgb));

}  // namespace sss
