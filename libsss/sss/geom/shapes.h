#pragma once
#include "sss/geom/triangle_mesh.h"

#include <limits>

namespace sss {

// The built-in shapes as triangles, in the unit of their arguments, centred on the origin, with
// exact normals and outward winding. Vertices lie on the true surface, so curved shapes fall short
// of it between them; nothing is scaled to make up for that. Edges are no longer than `maxEdge`
// (unless that would take more than kMaxShapeTriangles) and, on curved shapes, short enough by
// default that radius and volume are right to 1e-4: area deficits are 4.8e-5 (sphere) and 7.9e-5
// (disk, cylinder caps). Where a shape has sharp edges its vertices are split for their normals but
// coincide to the bit, so that the surface is watertight.

inline constexpr double kAnyEdge = std::numeric_limits<double>::infinity();
inline constexpr std::size_t kMaxShapeTriangles = 2'000'000;

/// Geodesic sphere: an icosahedron whose faces are cut into n^2 and projected; closed.
TriangleMesh makeSphere(double radius, double maxEdge = kAnyEdge);
/// In x and y, facing +z.
TriangleMesh makeRectangle(double width, double height, double maxEdge = kAnyEdge);
/// In x and y, facing +z.
TriangleMesh makeDisk(double radius, double maxEdge = kAnyEdge);
/// Closed; sharp edges.
TriangleMesh makeBox(const DVec3& size, double maxEdge = kAnyEdge);
/// Along y, capped and closed; sharp rims.
TriangleMesh makeCylinder(double radius, double height, double maxEdge = kAnyEdge);

}  // namespace sss
