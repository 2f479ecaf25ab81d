#pragma once
#include "sss/base/hash.h"
#include "sss/integrate/body_optics.h"
#include "sss/world/world.h"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sss {

/// One thing that pass 1 of a body depends on, under a name for the user ("the mesh", "the
/// lights").
struct InputFingerprint {
    std::string key;       ///< in the cache's metadata
    std::string sentence;  ///< what to say when it differs
    Fingerprint value;
};

using BodyInputs = std::vector<InputFingerprint>;

/// Everything that the cached points and irradiance of a body depend on, and nothing else: camera
/// and film are not among it, and of media only what light notices that has not entered yet: the
/// index, and of those that it may meet between its bounces the diffuse limit. Places are relative
/// to the first body (World's light space). `placedOn`: the mesh that the points were placed on, if
/// not the body's own (carried_points.h).
BodyInputs bodyInputs(const World& world, int body,
                      std::span<const std::unique_ptr<BodyOptics>> optics, double spacingMm,
                      const TriangleMesh* placedOn = nullptr);

/// What the exitance of a body depends on beside those.
InputFingerprint exitanceInput(const World& world, int body);

/// Keys of the inputs that points, and light, depend on.
std::vector<std::string_view> pointsKeys();
std::vector<std::string_view> lightKeys();

/// Of the stages: points; light (beams among it) with all that comes from the two; and what
/// diffusion on the shape makes of that, where the body asks for it (its inputs have a "shape").
Fingerprint pointsFingerprint(const BodyInputs& inputs);
Fingerprint lightFingerprint(const BodyInputs& inputs);
Fingerprint shapeFingerprint(const BodyInputs& inputs);

/// One fingerprint of the inputs called `keys`.
Fingerprint combined(const BodyInputs& inputs, const std::vector<std::string_view>& keys);

}  // namespace sss
