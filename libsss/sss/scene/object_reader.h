#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

/// The array "objects". The context holds the materials that they name. Objects without a name get
/// one: "bunny", then "bunny-2", ...
std::vector<ObjectSettings> readObjects(const Node& node);
void listObjectKeys(std::vector<KeyList>& out);

}  // namespace sss
