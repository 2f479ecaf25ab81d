#pragma once
#include "sss/light/light.h"
#include "sss/scene/scene.h"

namespace sss {

/// The light that `settings` describes, in a space whose origin is at `originMm` of the world.
/// Opens environment maps; throws Error{Io, BadInput} for those (see readExr and rgbMap).
std::unique_ptr<Light> makeLight(const LightSettings& settings, const DVec3& originMm);

}  // namespace sss
