#include "sss/geom/triangle_mesh.h"

#include "sss/geom/normals.h"

namespace sss {

std::vector<Vec3> angleWeightedNormals(const TriangleMesh& mesh) {
    std::vector<DVec3> sums(mesh.positions.size(), DVec3{0});
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face) {
        const UVec3 f = mesh.faces[face];
        const DVec3 normal = unitOrZero(mesh.faceCross(face));
        const DVec3 angles = cornerAngles(mesh, face);
        sums[f.x] += normal * angles.x;
        sums[f.y] += normal * angles.y;
        sums[f.z] += normal * angles.z;
    }
    std::vector<Vec3> normals;
    normals.reserve(sums.size());
    for (const DVec3& sum : sums) normals.emplace_back(unitOrZero(sum));
    return normals;
}

}  // namespace sss
