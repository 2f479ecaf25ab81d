#include "sss/world/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sss {
namespace {

// Shirley and Chiu's map of the square to the unit disk: keeps strata together.
Vec2 diskFromSquare(const Vec2& u) {
    const Vec2 s = u * 2.0f - Vec2(1.0f);
    if (s.x == 0.0f && s.y == 0.0f) return {0, 0};
    const bool wide = std::abs(s.x) > std::abs(s.y);
    const float radius = wide ? s.x : s.y;
    const float angle = wide ? kPiF / 4.0f * (s.y / s.x) : kPiF / 2.0f - kPiF / 4.0f * (s.x / s.y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

// Any direction that is not along `forward`, for cameras whose up vector is.
DVec3 usableUp(const DVec3& up, const DVec3& forward) {
    if (glm::length(glm::cross(forward, up)) > 1e-9 * glm::length(up)) return up;
    return std::abs(forward.y) < 0.9 ? DVec3(0, 1, 0) : DVec3(0, 0, 1);
}

}  // namespace

Camera::Camera(const CameraSettings& settings, int width, int height, const DVec3& originMm)
    : positionMm_(settings.position),
      position_(settings.position - originMm),
      tanHalfFov_(std::tan(settings.fovDegrees * kPi / 360.0)),
      tanPerPixel_(tanHalfFov_ / (0.5 * height)),
      width_(width),
      height_(height),
      apertureRadius_(static_cast<float>(settings.apertureRadiusMm)),
      focusDistance_(static_cast<float>(settings.focusDistanceMm > 0
                                            ? settings.focusDistanceMm
                                            : glm::length(settings.lookAt - settings.position))) {
    const DVec3 forward = glm::normalize(settings.lookAt - settings.position);
    const DVec3 right = glm::normalize(glm::cross(forward, usableUp(settings.up, forward)));
    forward_ = Vec3(forward);
    right_ = Vec3(right);
    up_ = Vec3(glm::cross(right, forward));
}

Ray Camera::ray(const Vec2& pixel, const Vec2& lens) const {
    const auto scale = static_cast<float>(tanPerPixel_);
    const float x = (pixel.x - 0.5f * static_cast<float>(width_)) * scale;
    const float y = (0.5f * static_cast<float>(height_) - pixel.y) * scale;
    const Vec3 through = forward_ + right_ * x + up_ * y;
    Ray ray;
    ray.origin = position_;
    ray.direction = glm::normalize(through);
    if (hasLens()) {
        const Vec2 offset = diskFromSquare(lens) * apertureRadius_;
        const Vec3 target = position_ + through * focusDistance_;
        ray.origin = position_ + right_ * offset.x + up_ * offset.y;
        ray.direction = glm::normalize(target - ray.origin);
    }
    return ray;
}

std::optional<Vec2> Camera::pixelOf(const Vec3& point) const {
    const DVec3 offset = DVec3(point) - DVec3(position_);
    const double depth = glm::dot(offset, DVec3(forward_));
    if (hasLens() || !(depth > 1e-3 * glm::length(offset))) return std::nullopt;
    const double scale = 1 / (depth * tanPerPixel_);
    return Vec2(0.5 * width_ + glm::dot(offset, DVec3(right_)) * scale,
                0.5 * height_ - glm::dot(offset, DVec3(up_)) * scale);
}

Camera::Window Camera::windowOf(const Bounds& box) const {
    constexpr float kFar = std::numeric_limits<float>::max();
    Window window{Vec2(kFar), Vec2(-kFar)};
    if (box.isEmpty()) return window;
    for (int corner = 0; corner < 8; ++corner) {
        const std::optional<Vec2> pixel =
            pixelOf({corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                     corner & 4 ? box.hi.z : box.lo.z});
        if (!pixel) return {Vec2(-kFar), Vec2(kFar)};
        window.lo = glm::min(window.lo, *pixel - kPixelError);
        window.hi = glm::max(window.hi, *pixel + kPixelError);
    }
    return window;
}

double Camera::pixelWidthMm(const Bounds& box) const {
    if (box.isEmpty()) return 0;
    const DVec3 lo = DVec3(box.lo) - DVec3(position_), hi = DVec3(box.hi) - DVec3(position_);
    double depth = 0;
    for (int k = 0; k < 3; ++k)
        depth += static_cast<double>(forward_[k]) * (forward_[k] > 0 ? lo[k] : hi[k]);
    if (!(depth > 0)) return 0;
    // Towards the film's corners a pixel is seen askew.
    const double right = tanHalfFov_ * width_ / height_;
    const double cosCorner = 1 / std::sqrt(1 + tanHalfFov_ * tanHalfFov_ + right * right);
    return depth * tanPerPixel_ * cosCorner;
}

std::array<double, 16> Camera::worldToCamera() const {
    // Camera space looks along -z, y up, as RenderMan's and Nuke's readers of this attribute
    // expect.
    const DVec3 axes[3] = {DVec3(right_), DVec3(up_), -DVec3(forward_)};
    std::array<double, 16> m{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            m[row * 4 + column] = axes[column][static_cast<int>(row)];
    for (std::size_t column = 0; column < 3; ++column)
        m[12 + column] = -glm::dot(positionMm_, axes[column]);
    m[15] = 1;
    return m;
}

std::array<double, 16> Camera::worldToNdc() const {
    const std::array<double, 16> view = worldToCamera();
    const double sy = 1.0 / tanHalfFov_;
    const double sx = sy * height_ / width_;
    std::array<double, 16> m{};
    for (std::size_t row = 0; row < 4; ++row) {
        m[row * 4 + 0] = view[row * 4 + 0] * sx;
        m[row * 4 + 1] = view[row * 4 + 1] * sy;
        m[row * 4 + 2] = -view[row * 4 + 2];  // depth, not remapped
        m[row * 4 + 3] = -view[row * 4 + 2];
    }
    return m;
}

}  // namespace sss
