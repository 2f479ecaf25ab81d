#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

CameraSettings readCamera(const Node& node);
KeyList cameraKeys();

}  // namespace sss
