#pragma once
#include "sss/base/rng.h"
#include "sss/geom/triangle_mesh.h"

namespace sss::testing {

/// Signed volume enclosed by a closed mesh.
inline double volumeOf(const TriangleMesh& mesh) {
    double six = 0;
    for (const UVec3& f : mesh.faces)
        six += glm::dot(mesh.positions[f.x], glm::cross(mesh.positions[f.y], mesh.positions[f.z]));
    return six / 6.0;
}

inline void flipFace(TriangleMesh& mesh, std::size_t face) {
    std::swap(mesh.faces[face].y, mesh.faces[face].z);
}

inline TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
    TriangleMesh sum = a;
    const auto base = static_cast<std::uint32_t>(a.positions.size());
    sum.positions.insert(sum.positions.end(), b.positions.begin(), b.positions.end());
    sum.normals.insert(sum.normals.end(), b.normals.begin(), b.normals.end());
    for (const UVec3& f : b.faces) sum.faces.push_back(f + UVec3{base});
    return sum;
}

inline TriangleMesh moved(TriangleMesh mesh, const DVec3& by) {
    for (DVec3& p : mesh.positions) p += by;
    return mesh;
}

inline Vec3 randomDirection(Rng& rng) {
    const float z = 1.0f - 2.0f * rng.uniform(), phi = 2.0f * kPiF * rng.uniform();
    const float r = std::sqrt(std::fmax(0.0f, 1.0f - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace sss::testing
