#pragma once
#include "sss/base/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Cuts a polygon into size - 2 triangles with its winding, given as indices into `corners`: fans
/// where it is convex, else ears [Meisters 1975] in the plane of its area vector. A polygon that
/// crosses itself, or is so large that cutting ears would take minutes (above 2,000 corners), gets
/// a fan: every corner is still used.
std::vector<UVec3> triangulatePolygon(std::span<const DVec3> corners);

}  // namespace sss
