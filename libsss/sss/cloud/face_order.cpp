#include "sss/cloud/face_order.h"

#include "sss/cloud/morton.h"

#include <algorithm>
#include <utility>

namespace sss {

std::vector<FaceIndex> facesInSpaceOrder(const TriangleMesh& mesh) {
    std::vector<Vec3> centroids(mesh.faceCount());
    Bounds box;
    for (FaceIndex f = 0; f < mesh.faceCount(); ++f) {
        const UVec3 v = mesh.faces[f];
        centroids[f] =
            Vec3((mesh.positions[v.x] + mesh.positions[v.y] + mesh.positions[v.z]) / 3.0);
        box.add(centroids[f]);
    }
    const MortonGrid grid(box);
    std::vector<std::pair<std::uint64_t, FaceIndex>> keyed(mesh.faceCount());
    for (FaceIndex f = 0; f < mesh.faceCount(); ++f) keyed[f] = {grid.code(centroids[f]), f};
    std::sort(keyed.begin(), keyed.end());
    std::vector<FaceIndex> order(mesh.faceCount());
    std::transform(keyed.begin(), keyed.end(), order.begin(),
                   [](const auto& k) { return k.second; });
    return order;
}

}  // namespace sss
