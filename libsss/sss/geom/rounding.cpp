#include "sss/geom/rounding.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

constexpr int kDigits = 36;
constexpr int kSmallestUnit = -30;

// Plus zero: -0.0 becomes 0.0.
DVec3 cut(const DVec3& v, double unit) { return glm::round(v / unit) * unit + 0.0; }

}  // namespace

DMat3 withoutRounding(const DMat3& m) {
    double largest = 0;
    for (int c = 0; c < 3; ++c) largest = std::max(largest, maxComponent(glm::abs(m[c])));
    const double unit = std::ldexp(1.0, std::ilogb(largest) - kDigits);
    return {cut(m[0], unit), cut(m[1], unit), cut(m[2], unit)};
}

DVec3 withoutRounding(const DVec3& mm) {
    const double largest = maxComponent(glm::abs(mm));
    if (!(largest > 0)) return mm;
    return cut(mm, std::ldexp(1.0, std::max(kSmallestUnit, std::ilogb(largest) - kDigits)));
}

}  // namespace sss
