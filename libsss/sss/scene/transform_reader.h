#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

/// The array "transform": steps in the order in which they are applied, lengths in mm.
std::vector<TransformStep> readTransform(const Node& node);
void listTransformKeys(std::vector<KeyList>& out);

}  // namespace sss
