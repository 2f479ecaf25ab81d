#pragma once
#include "sss/world/world.h"

namespace sss {

/// The mesh on which a body's points are placed, if not its own: in the reference frame (null:
/// there is none) it has the same faces, moved.
const TriangleMesh* placedOn(const World* reference, const Body& body, std::size_t index);

}  // namespace sss
