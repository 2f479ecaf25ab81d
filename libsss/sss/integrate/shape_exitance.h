#pragma once
#include "sss/base/reporter.h"
#include "sss/cloud/solved_exitance.h"
#include "sss/integrate/beam_sources.h"
#include "sss/integrate/body_optics.h"
#include "sss/integrate/collision_probability.h"
#include "sss/shape/shape_solver.h"

#include <array>
#include <vector>

namespace sss {

/// Diffusion on a body's own shape, as what it changes about the exitance that the profile gives.
struct ShapeExitance {
    std::vector<SolvedExitance> solved;  ///< by point
    ShapeReport report;
    SumCounts profile;  ///< what the first guess took, the profile's answer at the points
    /// Channels that keep the profile's answer: their points are too far apart to solve for, or
    /// what was solved does not keep the light. Those have no shares below.
    std::array<bool, 3> isTooCoarse{}, isUnsound{};
    /// Of what entered: how much more leaves than scattered, at most; 0 where it is less.
    double gain = 0;
    CollisionCounts collisions;  ///< what it took to know where the body is thin
    /// Of the clock on the wall: what scatters once, before all else, and that.
    double singleSeconds = 0, collisionSeconds = 0;
    /// Shares of the light that entered: multiple and single scattering that leaves, straight
    /// through, and absorbed (what is left).
    DRgb leaves{0}, single{0}, unscattered{0}, absorbed{0};
};

/// Solves it for a body with its points, light and beams, W m^-2; what single scattering shows (if
/// the material has it on) is taken out, place by place, so that both together leave what was
/// solved. `once`: the exitance of single scattering by point, or empty.
ShapeExitance solveShape(const World& world, int body, const BodyOptics& optics,
                         const BodyCloud::View& cloud, const EnteredBeams& beams,
                         std::span<const Rgb> once, Reporter& reporter);

}  // namespace sss
