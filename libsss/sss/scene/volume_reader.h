#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

/// The array "volumes": participating media in space.
std::vector<VolumeSettings> readVolumes(const Node& node);
void listVolumeKeys(std::vector<KeyList>& out);

}  // namespace sss
