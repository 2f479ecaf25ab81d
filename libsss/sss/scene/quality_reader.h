#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

QualitySettings readQuality(const Node& node);
KeyList qualityKeys();

}  // namespace sss
