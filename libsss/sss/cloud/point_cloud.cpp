#include "sss/cloud/point_cloud.h"

#include "sss/cloud/cloud_guard.h"

namespace sss {
namespace {

float signNotZero(float x) { return x < 0.0f ? -1.0f : 1.0f; }

std::uint32_t quantise(float x) {
    return static_cast<std::uint32_t>(
        std::lround((std::clamp(x, -1.0f, 1.0f) * 0.5f + 0.5f) * 65535.0f));
}

}  // namespace

std::uint32_t encodeUnitVector(const Vec3& n) {
    const float norm = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (!(norm > 0.0f)) return quantise(0.0f) | quantise(0.0f) << 16;
    Vec2 p{n.x / norm, n.y / norm};
    if (n.z < 0.0f)
        p = {(1.0f - std::abs(p.y)) * signNotZero(p.x), (1.0f - std::abs(p.x)) * signNotZero(p.y)};
    return quantise(p.x) | quantise(p.y) << 16;
}

Vec3 decodeUnitVector(std::uint32_t code) {
    const float x = static_cast<float>(code & 0xffffu) / 65535.0f * 2.0f - 1.0f;
    const float y = static_cast<float>(code >> 16) / 65535.0f * 2.0f - 1.0f;
    Vec3 n{x, y, 1.0f - std::abs(x) - std::abs(y)};
    if (n.z < 0.0f) {
        n.x = (1.0f - std::abs(y)) * signNotZero(x);
        n.y = (1.0f - std::abs(x)) * signNotZero(y);
    }
    return glm::normalize(n);
}

void CloudView::needAll() const {
    if (guard) guard->needAll();
}

}  // namespace sss
