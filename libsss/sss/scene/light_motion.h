#pragma once
#include "sss/geom/rigid.h"
#include "sss/scene/scene.h"

namespace sss {

/// The light moved and turned. An environment stays as it is: see hasDirection().
LightSettings movedLight(const LightSettings& light, const RigidTransform& motion);

/// Whether an environment looks different from a turned scene: it has a map.
bool hasDirection(const EnvironmentLight& light);

}  // namespace sss
