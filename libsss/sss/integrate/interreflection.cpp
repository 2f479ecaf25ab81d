#include "sss/integrate/interreflection.h"

#include <algorithm>

namespace sss {
namespace {

// From no point of it another can be seen: so are all shapes but meshes, however they are
// stretched.
bool isConvex(const World& world, const Body& body) {
    const auto first = static_cast<std::size_t>(body.objects.front());
    return body.objects.size() == 1 &&
           !std::holds_alternative<MeshFileShape>(world.scene().objects[first].shape);
}

bool reflects(const World& world, const ObjectSettings& object) {
    return !std::holds_alternative<EmitterMaterial>(world.material(object.material));
}

}  // namespace

bool mayComeBack(const World& world, int bodyIndex) {
    const Body& body = world.bodies()[static_cast<std::size_t>(bodyIndex)];
    const int bounces = world.scene().quality.bounces;
    if (bounces == 0) return false;
    if (!isConvex(world, body) || world.hasVolumes()) return true;
    // The first bounce is off something else, the second may be off the body.
    return bounces > 1 &&
           std::ranges::count_if(world.scene().objects, [&](const ObjectSettings& object) {
               return reflects(world, object);
           }) > 1;
}

}  // namespace sss
