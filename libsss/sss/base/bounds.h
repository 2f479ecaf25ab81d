#pragma once
#include "sss/base/vec.h"

#include <limits>

namespace sss {

/// Axis-aligned box. Default-constructed it is empty (lo > hi) and absorbs any point.
template <typename Vec>
struct Bounds3 {
    using Scalar = typename Vec::value_type;
    Vec lo{std::numeric_limits<Scalar>::max()};
    Vec hi{std::numeric_limits<Scalar>::lowest()};

    void add(const Vec& p) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    void add(const Bounds3& other) {
        if (other.isEmpty()) return;
        add(other.lo);
        add(other.hi);
    }
    bool isEmpty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
    Vec size() const { return isEmpty() ? Vec{0} : hi - lo; }
    Vec centre() const { return isEmpty() ? Vec{0} : lo + (hi - lo) * Scalar(0.5); }
    Scalar diagonal() const { return glm::length(size()); }
    /// Squared distance from `p` to the box; 0 inside.
    Scalar distanceSquared(const Vec& p) const {
        const Vec d = glm::max(glm::max(lo - p, p - hi), Vec{0});
        return glm::dot(d, d);
    }
};

using Bounds = Bounds3<Vec3>;
using DBounds = Bounds3<DVec3>;

}  // namespace sss
