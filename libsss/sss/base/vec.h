#pragma once
// The vector types of the whole project. GLM is the only third-party library whose types may
// stand in a header.

#define GLM_FORCE_XYZW_ONLY
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace sss {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using DVec2 = glm::dvec2;
using DVec3 = glm::dvec3;
using UVec3 = glm::uvec3;
using DMat3 = glm::dmat3;
using DMat4 = glm::dmat4;

/// A colour or any per-channel quantity: x = red, y = green, z = blue.
using Rgb = glm::vec3;
using DRgb = glm::dvec3;

inline constexpr double kPi = std::numbers::pi;
inline constexpr float kPiF = std::numbers::pi_v<float>;

// Comparisons, not fmax: one instruction each instead of a call, and no promise about NaN.
inline float maxComponent(const Vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
inline double maxComponent(const DVec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
inline double minComponent(const DVec3& v) { return std::min(v.x, std::min(v.y, v.z)); }
/// Plain mean over the channels; what sampling decisions are made with (not a luminance).
inline float meanComponent(const Vec3& v) { return (v.x + v.y + v.z) * (1.0f / 3.0f); }
inline bool isFinite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool isFinite(const DVec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool isZero(const Vec3& v) { return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f; }

/// Right-handed orthonormal frame around a unit `normal` [Duff et al. 2017], branch-free and
/// continuous but for normal.z = 0.
struct Frame {
    Vec3 tangent, bitangent, normal;
    explicit Frame(const Vec3& n) : normal(n) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        bitangent = {b, sign + n.y * n.y * a, -n.y};
    }
    Vec3 toWorld(const Vec3& local) const {
        return tangent * local.x + bitangent * local.y + normal * local.z;
    }
    Vec3 toLocal(const Vec3& world) const {
        return {glm::dot(world, tangent), glm::dot(world, bitangent), glm::dot(world, normal)};
    }
};

}  // namespace sss
