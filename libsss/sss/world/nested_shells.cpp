#include "sss/world/nested_shells.h"

#include "sss/geom/mesh_repair.h"
#include "sss/geom/winding.h"
#include "sss/world/body.h"

#include <algorithm>

namespace sss {
namespace {

DBounds boundsOf(const LoadedObject& object) {
    DBounds box;
    for (const DVec3& p : object.mesh().positions)
        box.add(DVec3(object.worldFromObject * glm::dvec4(p, 1.0)));
    return box;
}

// Spares most bodies the search: nothing is nested if no box lies in another.
bool mayBeNested(std::span<const int> members, std::span<const LoadedObject> loaded) {
    std::vector<DBounds> boxes;
    for (const int member : members)
        boxes.push_back(boundsOf(loaded[static_cast<std::size_t>(member)]));
    for (const DBounds& outer : boxes)
        for (const DBounds& inner : boxes)
            if (&outer != &inner && glm::all(glm::lessThan(outer.lo, inner.lo)) &&
                glm::all(glm::lessThan(inner.hi, outer.hi)))
                return true;
    return false;
}

}  // namespace

std::vector<int> turnNestedShells(std::span<const int> members, std::span<LoadedObject> loaded,
                                  const Scene& scene) {
    std::vector<int> turned;
    if (members.size() < 2 || !mayBeNested(members, loaded)) return turned;
    const Body body = joinBody({}, members, loaded, scene, DVec3(0));
    const WindingPlan plan = planWinding(body.mesh);
    for (std::size_t k = 0; k < members.size(); ++k) {
        LoadedObject& object = loaded[static_cast<std::size_t>(members[k])];
        std::vector<bool> flip(object.mesh().faceCount(), false);
        for (std::size_t f = 0; f < flip.size(); ++f) {
            const std::size_t face = body.firstFace[k] + f;
            const std::uint32_t component = plan.componentOfFace[face];
            // What is open has been turned as well as can be, by itself.
            flip[f] = plan.flip[face] && component != WindingPlan::kNoComponent &&
                      plan.components[component].closed;
        }
        if (std::find(flip.begin(), flip.end(), true) == flip.end()) continue;
        auto shape = std::make_shared<LoadedMesh>(*object.shape);
        turnFaces(shape->mesh, flip);
        Hasher hasher;
        addMesh(hasher, shape->mesh);
        shape->content = hasher.finish();
        object.shape = std::move(shape);
        turned.push_back(members[k]);
    }
    return turned;
}

}  // namespace sss
