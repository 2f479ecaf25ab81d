#pragma once
#include "sss/base/vec.h"

#include <algorithm>
#include <cmath>

namespace sss {

/// A direction of the hemisphere around +z with density cos / pi, from u in [0, 1)^2.
inline Vec3 cosineDirection(const Vec2& u) {
    const float radius = std::sqrt(u.x), phi = 2.0f * kPiF * u.y;
    return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(0.0f, 1.0f - u.x))};
}

}  // namespace sss
