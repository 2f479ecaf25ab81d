#pragma once
#include "sss/geom/triangle_mesh.h"

namespace sss {

/// `v` scaled to unit length; zero for a zero or non-finite vector. Safe for lengths whose square
/// would under- or overflow.
DVec3 unitOrZero(const DVec3& v);

/// The three inner angles of a face, radian; zero at corners that an edge of no length meets.
DVec3 cornerAngles(const TriangleMesh& mesh, FaceIndex face);

/// The mesh with smooth normals that stop at creases: around each position, faces joined by an edge
/// whose face normals differ by at most `creaseDegrees` share one angle-weighted normal; where a
/// position has several such fans it is split into vertices with bit-identical positions. Edges of
/// three or more faces, and edges between faces of opposite winding, are creases. Faces keep their
/// order and corners; existing normals are replaced; unreferenced vertices are left out.
TriangleMesh withCreases(const TriangleMesh& mesh, double creaseDegrees);

}  // namespace sss
