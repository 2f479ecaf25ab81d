#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

/// The object "materials": name to material.
std::vector<NamedMaterial> readMaterials(const Node& node);
void listMaterialKeys(std::vector<KeyList>& out);

}  // namespace sss
