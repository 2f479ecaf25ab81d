#pragma once
#include "sss/base/vec.h"

#include <cmath>

namespace sss::testing {

/// The unit direction of that cosine to +z and azimuth in radians.
inline Vec3 direction(double cosine, double azimuth) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return Vec3(DVec3{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
}

}  // namespace sss::testing
