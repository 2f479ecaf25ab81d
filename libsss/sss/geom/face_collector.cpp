#include "sss/geom/face_collector.h"

#include "sss/base/error.h"
#include "sss/geom/mesh_io.h"
#include "sss/geom/polygon.h"

#include <fmt/core.h>

#include <algorithm>

namespace sss {

std::uint32_t FaceCollector::addVertex(const Vec3& position) {
    positions_.push_back(position);
    return static_cast<std::uint32_t>(positions_.size() - 1);
}

void FaceCollector::setPosition(std::uint32_t vertex, const Vec3& position) {
    if (vertex < positions_.size()) positions_[vertex] = position;
}

void FaceCollector::addFace(std::span<const std::uint32_t> corners) {
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    faceEnds_.push_back(corners_.size());
}

void FaceCollector::checkRange(const std::string& where, std::size_t mostFaces) const {
    for (std::uint32_t corner : corners_)
        if (corner >= positions_.size())
            throw Error(ErrorKind::BadInput, where,
                        fmt::format("a face uses vertex {} of {}", corner, positions_.size()),
                        "export the mesh again");
    std::size_t triangles = 0, begin = 0;
    for (std::size_t end : faceEnds_) {
        if (end - begin >= 3) triangles += end - begin - 2;
        begin = end;
    }
    if (triangles > mostFaces || positions_.size() > mostFaces || corners_.size() > 0xffffffffu)
        throw Error(ErrorKind::BadInput, where,
                    fmt::format("{} triangles; at most {} can be used", triangles, mostFaces),
                    "simplify the mesh");
}

void FaceCollector::takeNormals(SievedMesh& exact, TriangleMesh& mesh, ReaderReport& report) {
    if (exact.normals.empty() && exact.cornerNormals.empty()) return;
    const bool byVertex = !exact.normals.empty();
    // Vertices that no face uses need no normal.
    report.hasFileNormals =
        byVertex ? std::none_of(corners_.begin(), corners_.end(),
                                [&](std::uint32_t corner) { return isZero(exact.normals[corner]); })
                 : std::none_of(exact.cornerNormals.begin(), exact.cornerNormals.end(), isZero);
    report.ignoredNormals = !report.hasFileNormals;
    if (report.ignoredNormals) return;
    if (byVertex) {
        mesh.normals = std::move(exact.normals);
    } else {
        const std::size_t before = mesh.positions.size();
        splitByNormal(exact.cornerNormals, mesh);
        report.splitVertices = mesh.positions.size() - before;
    }
}

/// Gives each vertex one normal: a further one makes a further vertex at the same position.
void FaceCollector::splitByNormal(const std::vector<Vec3>& cornerNormals, TriangleMesh& mesh) {
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> nextVariant(mesh.positions.size(), kNone);
    std::vector<bool> taken(mesh.positions.size(), false);
    mesh.normals.assign(mesh.positions.size(), Vec3{0});
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        std::uint32_t vertex = corners_[i];
        const Vec3& normal = cornerNormals[i];
        while (taken[vertex] && mesh.normals[vertex] != normal && nextVariant[vertex] != kNone)
            vertex = nextVariant[vertex];
        if (taken[vertex] && mesh.normals[vertex] != normal) {
            const auto added = static_cast<std::uint32_t>(mesh.positions.size());
            nextVariant[vertex] = added;
            nextVariant.push_back(kNone);
            taken.push_back(false);
            mesh.positions.push_back(mesh.positions[vertex]);
            mesh.normals.emplace_back(0);
            vertex = added;
        }
        taken[vertex] = true;
        mesh.normals[vertex] = normal;
        corners_[i] = vertex;
    }
}

namespace {

bool hasThreeDifferent(std::span<const std::uint32_t> face) {
    if (face.size() < 3) return false;
    const auto second =
        std::find_if(face.begin(), face.end(), [&](std::uint32_t v) { return v != face[0]; });
    return std::any_of(second, face.end(),
                       [&](std::uint32_t v) { return v != face[0] && v != *second; });
}

}  // namespace

TriangleMesh FaceCollector::build(SievedMesh* exact, ReaderReport& report, const std::string& where,
                                  std::size_t mostFaces) {
    checkRange(where, mostFaces);
    TriangleMesh mesh;
    if (exact) {
        mesh.positions = std::move(exact->positions);
        takeNormals(*exact, mesh, report);
    } else {
        mesh.positions.assign(positions_.begin(), positions_.end());
    }
    std::size_t begin = 0;
    std::vector<DVec3> polygon;
    for (std::size_t end : faceEnds_) {
        const std::span<const std::uint32_t> face(corners_.data() + begin, end - begin);
        begin = end;
        if (!hasThreeDifferent(face)) {
            ++report.droppedFaces;
        } else if (face.size() == 3) {
            mesh.faces.emplace_back(face[0], face[1], face[2]);
        } else {
            ++report.polygons;
            polygon.clear();
            for (std::uint32_t corner : face) polygon.push_back(mesh.positions[corner]);
            for (const UVec3& t : triangulatePolygon(polygon))
                mesh.faces.emplace_back(face[t.x], face[t.y], face[t.z]);
        }
    }
    return mesh;
}

}  // namespace sss
