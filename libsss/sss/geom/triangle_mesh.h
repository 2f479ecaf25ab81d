#pragma once
#include "sss/base/bounds.h"
#include "sss/base/vec.h"

#include <cstdint>
#include <vector>

namespace sss {

using FaceIndex = std::uint32_t;

/// Indexed triangles. Positions are double so that a mesh far from the origin keeps its shape until
/// it is moved to where it is used; the unit is whatever the owner says (file units in a reader, mm
/// past the world builder).
struct TriangleMesh {
    std::vector<DVec3> positions;
    /// Unit shading normals, one a vertex; empty = shade with the faces' own normals.
    std::vector<Vec3> normals;
    std::vector<UVec3> faces;

    std::size_t faceCount() const { return faces.size(); }
    /// Twice the area vector: direction by the right-hand rule, length = 2 x area.
    DVec3 faceCross(FaceIndex face) const {
        const UVec3 f = faces[face];
        return glm::cross(positions[f.y] - positions[f.x], positions[f.z] - positions[f.x]);
    }
    /// The place of a face with these barycentrics (of its second and third corner).
    DVec3 positionAt(FaceIndex face, const DVec2& b) const {
        const UVec3 f = faces[face];
        return positions[f.x] * (1.0 - b.x - b.y) + positions[f.y] * b.x + positions[f.z] * b.y;
    }
    double faceArea(FaceIndex face) const { return 0.5 * glm::length(faceCross(face)); }
    double area() const {
        double sum = 0;
        for (FaceIndex face = 0; face < faces.size(); ++face) sum += faceArea(face);
        return sum;
    }
    DBounds bounds() const {
        DBounds box;
        for (const DVec3& p : positions) box.add(p);
        return box;
    }
};

/// Angle-weighted vertex normals (unit; zero where every adjacent face is degenerate).
std::vector<Vec3> angleWeightedNormals(const TriangleMesh& mesh);

}  // namespace sss
