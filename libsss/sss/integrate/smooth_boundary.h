#pragma once
#include "sss/base/vec.h"
#include "sss/world/world.h"

namespace sss {

/// A propagation direction bent at a boundary: `along` arrives against `normal`. `eta` is the index
/// beyond over the index before; the cosines are of both directions, Snell's law holding.
inline Vec3 refractedDirection(const Vec3& along, const Vec3& normal, float cosBefore,
                               float cosBeyond, float eta) {
    return along / eta + normal * (cosBefore / eta - cosBeyond);
}

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
