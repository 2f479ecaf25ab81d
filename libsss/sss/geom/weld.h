#pragma once
#include "sss/base/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// For each position the lowest index of an identical one (bit for bit; -0 equals 0), so that
/// vertices split for their normals count as one place. NaN equals nothing.
std::vector<std::uint32_t> weldPositions(std::span<const DVec3> positions);

}  // namespace sss
