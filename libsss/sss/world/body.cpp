#include "sss/world/body.h"

#include "sss/geom/rounding.h"

#include <algorithm>
#include <utility>

namespace sss {

TriangleMesh transformedMesh(const TriangleMesh& mesh, const DMat3& linear, const DVec3& offset) {
    TriangleMesh result = mesh;
    for (DVec3& p : result.positions) p = linear * p + offset;
    const double determinant = glm::determinant(linear);
    const DMat3 forNormals = glm::transpose(glm::inverse(linear));
    for (Vec3& n : result.normals) {
        const DVec3 turned = forNormals * DVec3(n);
        const double length = glm::length(turned);
        if (length > 0) n = Vec3(turned / length);
    }
    if (determinant < 0)
        for (UVec3& f : result.faces) std::swap(f.y, f.z);
    return result;
}

namespace {

void append(TriangleMesh& whole, TriangleMesh part) {
    const auto first = static_cast<std::uint32_t>(whole.positions.size());
    whole.positions.insert(whole.positions.end(), part.positions.begin(), part.positions.end());
    whole.normals.insert(whole.normals.end(), part.normals.begin(), part.normals.end());
    for (const UVec3& f : part.faces) whole.faces.push_back(f + UVec3(first));
}

// A body has normals for all vertices or for none: a flat part among smooth ones gets its faces'
// normals, at vertices of their own.
TriangleMesh withFlatNormals(const TriangleMesh& mesh) {
    TriangleMesh split;
    for (FaceIndex f = 0; f < mesh.faceCount(); ++f) {
        const auto first = static_cast<std::uint32_t>(split.positions.size());
        const Vec3 normal(glm::normalize(mesh.faceCross(f)));
        for (int k = 0; k < 3; ++k) {
            split.positions.push_back(mesh.positions[mesh.faces[f][k]]);
            split.normals.push_back(normal);
        }
        split.faces.push_back({first, first + 1, first + 2});
    }
    return split;
}

}  // namespace

Vec3 Body::normalAt(FaceIndex face, const Vec2& barycentrics) const {
    const UVec3 v = mesh.faces[face];
    if (!mesh.normals.empty()) {
        const Vec3 n = mesh.normals[v.x] * (1.0f - barycentrics.x - barycentrics.y) +
                       mesh.normals[v.y] * barycentrics.x + mesh.normals[v.z] * barycentrics.y;
        const float length = glm::length(n);
        if (length > 1e-6f) return n / length;
    }
    return Vec3(glm::normalize(mesh.faceCross(face)));
}

Body joinBody(std::string name, std::span<const int> members, std::span<const LoadedObject> loaded,
              const Scene& scene, const DVec3& originMm) {
    Body body;
    body.name = std::move(name);
    body.closed = true;
    body.objects.assign(members.begin(), members.end());
    const auto at = [&](int member) -> const LoadedObject& {
        return loaded[static_cast<std::size_t>(member)];
    };
    body.material = scene.objects[static_cast<std::size_t>(members.front())].material;

    // The first member's rotation and place make the body's space; its own part of the mesh is
    // then a pure stretch of the object, free of where and how the object stands.
    const LoadedObject& leader = at(members.front());
    const PolarParts polar = polarDecompose(DMat3(leader.worldFromObject));
    const DMat3 bodyFromWorld = glm::transpose(polar.rotation);
    const DVec3 leaderOffset(leader.worldFromObject[3]);
    bool smooth = false;
    for (const int member : members) smooth = smooth || !at(member).mesh().normals.empty();
    for (const int member : members) {
        const LoadedObject& object = at(member);
        const bool leads = member == members.front();
        const DMat3 linear =
            withoutRounding(leads ? polar.stretch : bodyFromWorld * DMat3(object.worldFromObject));
        const DVec3 offset =
            leads ? DVec3(0)
                  : withoutRounding(bodyFromWorld *
                                    (DVec3(object.worldFromObject[3]) - leaderOffset));
        TriangleMesh part = transformedMesh(object.mesh(), linear, offset);
        if (smooth && part.normals.empty()) part = withFlatNormals(part);
        body.firstFace.push_back(static_cast<FaceIndex>(body.mesh.faceCount()));
        append(body.mesh, std::move(part));
        body.closed = body.closed && object.closed();
    }
    const DVec3 centre = body.mesh.bounds().centre();
    for (DVec3& p : body.mesh.positions) p -= centre;
    body.worldFromBody = {polar.rotation, polar.rotation * centre + leaderOffset - originMm};
    return body;
}

}  // namespace sss
