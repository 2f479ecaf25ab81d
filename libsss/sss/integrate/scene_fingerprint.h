#pragma once
#include "sss/base/hash.h"
#include "sss/world/world.h"

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

/// Everything that the cached points and irradiance of a body depend on, and nothing else: camera
/// and film are not among it.
std::vector<InputFingerprint> bodyInputs(const World& world, int body, double spacingMm);

/// One fingerprint of the inputs called `keys`.
Fingerprint combined(const std::vector<InputFingerprint>& inputs,
                     const std::vector<std::string_view>& keys);

/// One fingerprint of them all.
Fingerprint combined(const std::vector<InputFingerprint>& inputs);

}  // namespace sss
