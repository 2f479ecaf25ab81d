#pragma once
#include "sss/geom/triangle_mesh.h"

namespace sss {

struct WindingRepair {
    std::size_t flippedFaces = 0;       ///< in total
    std::size_t flippedComponents = 0;  ///< turned as a whole
};

/// Turns the faces that `flip` says, and shading normals that then point away from all their faces.
void turnFaces(TriangleMesh& mesh, const std::vector<bool>& flip);

/// Turns faces as planWinding says.
WindingRepair repairWinding(TriangleMesh& mesh);

struct RemovedParts {
    std::size_t degenerateFaces = 0;
    std::size_t duplicateFaces = 0;
    std::size_t unreferencedVertices = 0;
};

/// Whether a face has no usable area: a height below 1e-10 of its longest edge, or a repeated
/// position.
bool isDegenerate(const TriangleMesh& mesh, FaceIndex face);

/// Faces that use the same three positions as an earlier one, in any order or winding; by face.
std::vector<bool> findDuplicateFaces(const TriangleMesh& mesh);

/// Removes degenerate faces, duplicate faces (the first stays) and then vertices that no face uses;
/// the others keep their order.
RemovedParts removeUnusable(TriangleMesh& mesh);

}  // namespace sss
