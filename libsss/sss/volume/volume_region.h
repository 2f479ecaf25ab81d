#pragma once
#include "sss/geom/ray_scene.h"
#include "sss/geom/triangle_mesh.h"

#include <memory>
#include <vector>

namespace sss {

/// A stretch of a ray, mm along it.
struct RayInterval {
    double begin = 0, end = 0;
};
/// A line in the space of the unit cube: origin and change per mm.
struct UnitLine {
    DVec3 origin, direction;
    DVec3 at(double t) const { return origin + direction * t; }
};

/// Where [0, end] of a line lies in the unit cube; empty if begin >= end.
RayInterval clipToUnitCube(const UnitLine& line, double end);
/// The same in the ball that touches the faces of the unit cube from within.
RayInterval clipToUnitBall(const UnitLine& line, double end);

/// The inside of a closed mesh, found by rays.
class MeshInterior {
public:
    /// `mesh` in the space of the rays.
    explicit MeshInterior(const TriangleMesh& mesh);
    /// Appends where [0, end] of a ray of unit direction lies inside.
    void clip(const Vec3& origin, const Vec3& direction, double end,
              std::vector<RayInterval>& inside) const;

private:
    std::unique_ptr<RayScene> rays_;
};

}  // namespace sss
