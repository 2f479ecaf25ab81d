#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

/// The array "lights".
std::vector<LightSettings> readLights(const Node& node);
void listLightKeys(std::vector<KeyList>& out);

}  // namespace sss
