#pragma once
#include "sss/scene/scene.h"
#include "sss/world/object_loader.h"

#include <span>
#include <vector>

namespace sss {

/// Turns inward what lies inside an odd number of the other closed surfaces of one body: the walls
/// of its hollows, which every object by itself has outward. Such objects of `members` (indices
/// into `loaded`) get a shape of their own; they are returned.
std::vector<int> turnNestedShells(std::span<const int> members, std::span<LoadedObject> loaded,
                                  const Scene& scene);

}  // namespace sss
