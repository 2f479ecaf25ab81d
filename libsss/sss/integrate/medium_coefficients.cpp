#include "sss/integrate/medium_coefficients.h"

#include "sss/optics/phase.h"

#include <algorithm>

namespace sss {

Vec3 sampleScattered(const Vec3& along, float g, const Vec2& u) {
    const float cosTheta = sampleHenyeyGreenstein(u.x, g);
    const float sinTheta = std::sqrt(std::max(0.0f, 1.0f - cosTheta * cosTheta));
    const float phi = 2.0f * kPiF * u.y;
    return Frame(along).toWorld({sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta});
}

Rgb phaseBetween(const MediumCoefficients& medium, const Vec3& before, const Vec3& after) {
    const float cosTheta = std::clamp(glm::dot(before, after), -1.0f, 1.0f);
    Rgb phase;
    for (int c = 0; c < 3; ++c) phase[c] = henyeyGreenstein(cosTheta, medium.g[c]);
    return phase;
}

}  // namespace sss
