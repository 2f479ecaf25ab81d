#include "sss/app/placed_on.h"

namespace sss {

const TriangleMesh* placedOn(const World* reference, const Body& body, std::size_t index) {
    if (reference == nullptr || index >= reference->bodies().size()) return nullptr;
    const Body& other = reference->bodies()[index];
    const TriangleMesh& mesh = other.mesh;
    if (other.name != body.name || mesh.faces != body.mesh.faces ||
        mesh.positions == body.mesh.positions)
        return nullptr;
    return &mesh;
}

}  // namespace sss
