#pragma once
#include "sss/base/vec.h"

namespace sss {

/// A propagation direction bent at a boundary: `along` arrives against `normal`. `eta` is the index
/// beyond over the index before; the cosines are of both directions, Snell's law holding.
inline Vec3 refractedDirection(const Vec3& along, const Vec3& normal, float cosBefore,
                               float cosBeyond, float eta) {
    return along / eta + normal * (cosBefore / eta - cosBeyond);
}

}  // namespace sss
