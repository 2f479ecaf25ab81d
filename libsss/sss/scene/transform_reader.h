#pragma once
#include "sss/geom/rigid.h"
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

/// The array "transform": steps in the order in which they are applied, lengths in mm.
std::vector<TransformStep> readTransform(const Node& node);
/// The same of a camera or a light, which can be moved and turned, but not scaled, sheared or
/// mirrored.
RigidTransform readMotion(const Node& node);
void listTransformKeys(std::vector<KeyList>& out);

}  // namespace sss
