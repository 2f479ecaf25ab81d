#include "sss/geom/normals.h"

#include "sss/geom/edges.h"

#include <algorithm>

namespace sss {

DVec3 unitOrZero(const DVec3& v) {
    const double largest = maxComponent(glm::abs(v));
    if (!(largest > 0) || !isFinite(v)) return DVec3{0};
    const DVec3 scaled = v / largest;
    return scaled / glm::length(scaled);
}

DVec3 cornerAngles(const TriangleMesh& mesh, FaceIndex face) {
    const UVec3 f = mesh.faces[face];
    const DVec3 a = unitOrZero(mesh.positions[f.y] - mesh.positions[f.x]);
    const DVec3 b = unitOrZero(mesh.positions[f.z] - mesh.positions[f.y]);
    const DVec3 c = unitOrZero(mesh.positions[f.x] - mesh.positions[f.z]);
    // atan2 keeps the small angles of needles, which acos of a dot product would lose.
    const auto angle = [](const DVec3& u, const DVec3& v) {
        return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
    };
    const DVec3 none{0};
    return {a == none || c == none ? 0 : angle(a, -c), a == none || b == none ? 0 : angle(b, -a),
            b == none || c == none ? 0 : angle(c, -b)};
}

namespace {

std::uint32_t cornerId(FaceIndex face, unsigned corner) { return face * 3 + corner; }

/// Joins the corners of faces that meet smoothly: afterwards one set is one vertex.
DisjointSets smoothFans(const TriangleMesh& mesh, const std::vector<DVec3>& faceNormals,
                        double creaseDegrees) {
    const double minCosine = std::cos(creaseDegrees * kPi / 180.0);
    DisjointSets fans(mesh.faces.size() * 3);
    EdgeTable(mesh).forEachEdge([&](std::span<const FaceSide> sides) {
        if (sides.size() != 2 || sides[0].forward == sides[1].forward) return;
        const FaceSide &a = sides[0], &b = sides[1];
        const double cosine = glm::dot(faceNormals[a.face], faceNormals[b.face]);
        // A tie, such as a box's 90 degrees at a crease angle of 90, must not depend on rounding.
        if (cosine < minCosine - 1e-9) return;
        fans.unite(cornerId(a.face, a.corner), cornerId(b.face, (b.corner + 1u) % 3));
        fans.unite(cornerId(a.face, (a.corner + 1u) % 3), cornerId(b.face, b.corner));
    });
    return fans;
}

}  // namespace

TriangleMesh withCreases(const TriangleMesh& mesh, double creaseDegrees) {
    std::vector<DVec3> faceNormals(mesh.faces.size());
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face)
        faceNormals[face] = unitOrZero(mesh.faceCross(face));
    DisjointSets fans = smoothFans(mesh, faceNormals, creaseDegrees);

    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> vertexOfFan(mesh.faces.size() * 3, kNone);
    std::uint32_t vertices = 0;
    TriangleMesh out;
    out.faces = mesh.faces;
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face)
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t fan = fans.find(cornerId(face, static_cast<unsigned>(corner)));
            if (vertexOfFan[fan] == kNone) vertexOfFan[fan] = vertices++;
            out.faces[face][corner] = vertexOfFan[fan];
        }

    out.positions.assign(vertices, DVec3{0});
    std::vector<DVec3> sums(vertices, DVec3{0});
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face) {
        const DVec3 angles = cornerAngles(mesh, face);
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = out.faces[face][corner];
            out.positions[vertex] = mesh.positions[mesh.faces[face][corner]];
            sums[vertex] += faceNormals[face] * angles[corner];
        }
    }
    out.normals.reserve(vertices);
    for (const DVec3& sum : sums) out.normals.emplace_back(unitOrZero(sum));
    return out;
}

}  // namespace sss
