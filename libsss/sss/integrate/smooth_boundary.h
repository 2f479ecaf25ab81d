#pragma once
#include "sss/optics/refraction.h"
#include "sss/world/world.h"

namespace sss {

/// What becomes of a path at a smooth dielectric boundary: it is reflected with the probability of
/// Fresnel's reflectance and refracted otherwise, so that its weight stays what it is.
struct BoundaryEvent {
    bool isReflected = false;
    bool isInside = false;  ///< whether the path goes on inside the body
    Vec3 direction{};       ///< unit
    Vec3 side{};            ///< unit geometric normal on the side where the path goes on
};

/// `along` arrives at `hit` from either side; `eta` = inside / outside. Interpolated normals bend
/// light unless that would send it to the wrong side of the face; then the face's own normal does.
BoundaryEvent sampleBoundary(const SurfaceHit& hit, const Vec3& along, float eta, float u);

}  // namespace sss
