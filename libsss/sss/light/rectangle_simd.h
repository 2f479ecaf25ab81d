#pragma once
#include "sss/light/light.h"

#include <span>

namespace sss {

/// A rectangle that light is sampled from, in float; lengths in mm.
struct RectangleFrame {
    Vec3 centre, across, up, normal;  ///< the last three unit and orthogonal
    float halfWidth, halfHeight;
};

/// Sends rays from points in front of the rectangle towards it, uniformly over the solid angle that
/// it fills, by SphericalRectangle in float: directions, distances and densities are set where they
/// are within some 1e-6 of that in double, and the density is 0 elsewhere, which is for the caller
/// to do: far away, very near, and behind. SIMD; the same to a few units in the last place on every
/// instruction set.
void sampleRectangle(const RectangleFrame& rectangle, std::span<const Vec3> from,
                     std::span<const Vec2> u, std::span<LightSample> samples);

}  // namespace sss
