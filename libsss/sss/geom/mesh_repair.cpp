#include "sss/geom/mesh_repair.h"

#include "sss/base/rng.h"
#include "sss/geom/normals.h"
#include "sss/geom/weld.h"
#include "sss/geom/winding.h"

#include <algorithm>
#include <array>
#include <bit>

namespace sss {

namespace {

/// Turns the normals of flipped faces' vertices that no longer point to the faces' outer side.
void turnNormals(TriangleMesh& mesh, const std::vector<bool>& flip) {
    std::vector<DVec3> outward(mesh.positions.size(), DVec3{0});
    std::vector<bool> touched(mesh.positions.size(), false);
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face) {
        const DVec3 normal = unitOrZero(mesh.faceCross(face));
        const UVec3 f = mesh.faces[face];
        for (int c = 0; c < 3; ++c) {
            outward[f[c]] += normal;
            if (flip[face]) touched[f[c]] = true;
        }
    }
    for (std::size_t v = 0; v < outward.size(); ++v)
        if (touched[v] && glm::dot(outward[v], DVec3(mesh.normals[v])) < 0)
            mesh.normals[v] = -mesh.normals[v];
}

std::array<std::uint32_t, 3> sortedCorners(const UVec3& f) {
    std::array<std::uint32_t, 3> v{f.x, f.y, f.z};
    std::sort(v.begin(), v.end());
    return v;
}

std::size_t removeUnreferenced(TriangleMesh& mesh) {
    std::vector<std::uint32_t> index(mesh.positions.size(), 0);
    for (const UVec3& f : mesh.faces)
        for (int c = 0; c < 3; ++c) index[f[c]] = 1;
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < index.size(); ++v) {
        if (!index[v]) continue;
        mesh.positions[kept] = mesh.positions[v];
        if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[v];
        index[v] = kept++;
    }
    const std::size_t removed = mesh.positions.size() - kept;
    mesh.positions.resize(kept);
    if (!mesh.normals.empty()) mesh.normals.resize(kept);
    for (UVec3& f : mesh.faces) f = {index[f.x], index[f.y], index[f.z]};
    return removed;
}

}  // namespace

void turnFaces(TriangleMesh& mesh, const std::vector<bool>& flip) {
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face)
        if (flip[face]) std::swap(mesh.faces[face].y, mesh.faces[face].z);
    if (!mesh.normals.empty()) turnNormals(mesh, flip);
}

WindingRepair repairWinding(TriangleMesh& mesh) {
    const WindingPlan plan = planWinding(mesh);
    WindingRepair repair;
    for (const WindingPlan::Component& component : plan.components)
        if (component.turned) ++repair.flippedComponents;
    repair.flippedFaces =
        static_cast<std::size_t>(std::count(plan.flip.begin(), plan.flip.end(), true));
    if (repair.flippedFaces > 0) turnFaces(mesh, plan.flip);
    return repair;
}

bool isDegenerate(const TriangleMesh& mesh, FaceIndex face) {
    const UVec3 f = mesh.faces[face];
    const DVec3 a = mesh.positions[f.y] - mesh.positions[f.x];
    const DVec3 b = mesh.positions[f.z] - mesh.positions[f.y];
    const DVec3 c = mesh.positions[f.x] - mesh.positions[f.z];
    const double longest =
        std::max({maxComponent(glm::abs(a)), maxComponent(glm::abs(b)), maxComponent(glm::abs(c))});
    if (!(longest > 0)) return true;
    // Scaled first, so that tiny and huge triangles do not under- or overflow when squared.
    const DVec3 u = a / longest, v = c / longest;
    return !(glm::length(glm::cross(u, v)) > 1e-10);
}

std::vector<bool> findDuplicateFaces(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> welded = weldPositions(mesh.positions);
    const auto key = [&](FaceIndex face) {
        const UVec3 f = mesh.faces[face];
        return sortedCorners({welded[f.x], welded[f.y], welded[f.z]});
    };
    constexpr std::uint32_t kFree = 0xffffffffu;
    const std::size_t slots = std::bit_ceil(mesh.faces.size() * 2 + 1);
    std::vector<std::uint32_t> table(slots, kFree);
    std::vector<bool> duplicate(mesh.faces.size(), false);
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face) {
        const std::array<std::uint32_t, 3> own = key(face);
        std::size_t slot = combineSeeds(combineSeeds(own[0], own[1]), own[2]) & (slots - 1);
        while (table[slot] != kFree && key(table[slot]) != own) slot = (slot + 1) & (slots - 1);
        if (table[slot] == kFree)
            table[slot] = face;
        else
            duplicate[face] = true;
    }
    return duplicate;
}

RemovedParts removeUnusable(TriangleMesh& mesh) {
    RemovedParts removed;
    const std::vector<bool> duplicate = findDuplicateFaces(mesh);
    std::vector<UVec3> kept;
    kept.reserve(mesh.faces.size());
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face) {
        if (isDegenerate(mesh, face))
            ++removed.degenerateFaces;
        else if (duplicate[face])
            ++removed.duplicateFaces;
        else
            kept.push_back(mesh.faces[face]);
    }
    mesh.faces = std::move(kept);
    removed.unreferencedVertices = removeUnreferenced(mesh);
    return removed;
}

}  // namespace sss
