#pragma once
#include "sss/geom/triangle_mesh.h"

#include <vector>

namespace sss {

/// The faces of a mesh in Z-order of their centroids, ties by index: neighbours in the list lie
/// near each other on the surface. O(n log n).
std::vector<FaceIndex> facesInSpaceOrder(const TriangleMesh& mesh);

}  // namespace sss
