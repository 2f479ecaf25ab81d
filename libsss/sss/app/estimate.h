#pragma once
#include "sss/base/json.h"
#include "sss/integrate/preprocess.h"

#include <span>

namespace sss {

/// What pass 1 of a world will cost, before it is done: {"points", "memoryBytes", "seconds",
/// "bodies": [{"name", "points", "spacingMm"}]}. Seconds are measured on a few points of each body,
/// with the threads there are; memory is that of the points and their cells, beside the meshes'.
JsonValue estimatePassOne(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics);

}  // namespace sss
