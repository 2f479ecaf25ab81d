#pragma once
#include "sss/base/json.h"
#include "sss/integrate/scene_fingerprint.h"

#include <string>
#include <vector>

namespace sss {

/// One stage of one body in one frame: whether it was there already, and if not, why.
struct StageRow {
    std::string body;
    std::string stage;  ///< points, irradiance, octree, shape, exitance
    bool reused = false;
    std::string why;  ///< empty if reused
};

/// "bunny: irradiance made: the lights are others".
std::string sentenceOf(const StageRow& row);
JsonValue toJson(const std::vector<StageRow>& rows);

/// What differs between the inputs of two makings of a stage, of those called `keys` (all if none),
/// in words; empty if nothing does.
std::string differences(const BodyInputs& now, const BodyInputs& before,
                        const std::vector<std::string_view>& keys);

}  // namespace sss
