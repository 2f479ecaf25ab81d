#include "sss/geom/face_collector.h"

#include "sss/base/error.h"
#include "sss/geom/mesh_io.h"
#include "sss/geom/normals.h"
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

void FaceCollector::setCornerNormal(std::uint32_t vertex, const Vec3& normal) {
    pending_.push_back({vertex, Vec3(unitOrZero(DVec3(normal)))});
}

void FaceCollector::addFace(std::span<const std::uint32_t> corners) {
    storeCornerNormals(corners);
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    faceEnds_.push_back(corners_.size());
}

/// The normals come in the order of the corners. Matched from the back, so that those of a face
/// which the reader gave up do not count for this one.
void FaceCollector::storeCornerNormals(std::span<const std::uint32_t> corners) {
    if (pending_.empty() && cornerNormals_.empty()) return;
    cornerNormals_.resize(corners_.size() + corners.size(), Vec3{0});
    std::size_t left = pending_.size();
    for (std::size_t i = corners.size(); i-- > 0;) {
        std::size_t at = left;
        while (at > 0 && pending_[at - 1].vertex != corners[i]) --at;
        if (at == 0) continue;
        cornerNormals_[corners_.size() + i] = pending_[at - 1].normal;
        left = at - 1;
    }
    pending_.clear();
}

void FaceCollector::checkRange(const std::string& where) const {
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
    if (triangles > kMaxFaces || positions_.size() > kMaxFaces || corners_.size() > 0xffffffffu)
        throw Error(ErrorKind::BadInput, where,
                    fmt::format("{} triangles; at most {} can be used", triangles, kMaxFaces),
                    "simplify the mesh");
}

bool FaceCollector::hasAllCornerNormals(ReaderReport& report) {
    if (cornerNormals_.empty()) return false;
    cornerNormals_.resize(corners_.size(), Vec3{0});
    report.hasFileNormals = std::none_of(cornerNormals_.begin(), cornerNormals_.end(), isZero);
    report.ignoredNormals = !report.hasFileNormals;
    return report.hasFileNormals;
}

/// Vertices that no face uses need no normal.
bool FaceCollector::coversAllCorners(const std::vector<Vec3>& vertexNormals) const {
    return std::none_of(corners_.begin(), corners_.end(),
                        [&](std::uint32_t corner) { return isZero(vertexNormals[corner]); });
}

/// Gives each vertex one normal: a further one makes a further vertex at the same position.
void FaceCollector::splitByNormal(TriangleMesh& mesh) {
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> nextVariant(mesh.positions.size(), kNone);
    std::vector<bool> taken(mesh.positions.size(), false);
    mesh.normals.assign(mesh.positions.size(), Vec3{0});
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        std::uint32_t vertex = corners_[i];
        const Vec3& normal = cornerNormals_[i];
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

TriangleMesh FaceCollector::build(Exact exact, ReaderReport& report, const std::string& where) {
    checkRange(where);
    TriangleMesh mesh;
    if (exact.positions.empty())
        mesh.positions.assign(positions_.begin(), positions_.end());
    else
        mesh.positions = std::move(exact.positions);
    if (!exact.normals.empty()) {
        report.hasFileNormals = coversAllCorners(exact.normals);
        report.ignoredNormals = !report.hasFileNormals;
        if (report.hasFileNormals) mesh.normals = std::move(exact.normals);
    } else if (hasAllCornerNormals(report)) {
        const std::size_t before = mesh.positions.size();
        splitByNormal(mesh);
        report.splitVertices = mesh.positions.size() - before;
    }
    std::size_t begin = 0;
    std::vector<DVec3> polygon;
    for (std::size_t end : faceEnds_) {
        const std::span<const std::uint32_t> face(corners_.data() + begin, end - begin);
        begin = end;
        if (face.size() < 3) {
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
