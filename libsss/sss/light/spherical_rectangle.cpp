#include "sss/light/spherical_rectangle.h"

#include <algorithm>

namespace sss {
namespace {

/// Signed solid angle of the rectangle from the foot of the perpendicular to the corner (x, y).
double cornerAngle(double x, double y, double height) {
    return std::atan(x * y / (height * std::sqrt(x * x + y * y + height * height)));
}

}  // namespace

SphericalRectangle::SphericalRectangle(const RectangleView& view) : view_(view) {
    const double h = view.height;
    const double a00 = cornerAngle(view.x0, view.y0, h), a01 = cornerAngle(view.x0, view.y1, h);
    const double a10 = cornerAngle(view.x1, view.y0, h), a11 = cornerAngle(view.x1, view.y1, h);
    solidAngle_ = std::max(0.0, (a11 - a01) - (a10 - a00));
    offset_ = a01 - a00;
    b0_ = -view.y0 / std::sqrt(h * h + view.y0 * view.y0);
    b1_ = view.y1 / std::sqrt(h * h + view.y1 * view.y1);
}

DVec2 SphericalRectangle::sample(const DVec2& u) const {
    // x from the share of the solid angle to its left; sine and cosine of the paper's angle au
    // change sign with pi taken out of k.
    const double angle = u.x * solidAngle_ + offset_;
    const double sinAngle = std::sin(angle);
    const double f = (std::cos(angle) * b0_ + b1_) / sinAngle;
    const double c = std::clamp(std::copysign(1.0, f) / std::sqrt(f * f + b0_ * b0_), -1.0, 1.0);
    const double x =
        std::clamp(c * view_.height / std::sqrt(std::max(1e-300, 1 - c * c)), view_.x0, view_.x1);

    // y uniformly in the height h of Archimedes' cylinder.
    const double d2 = x * x + view_.height * view_.height;
    const double h0 = view_.y0 / std::sqrt(d2 + view_.y0 * view_.y0);
    const double h1 = view_.y1 / std::sqrt(d2 + view_.y1 * view_.y1);
    const double hv = h0 + u.y * (h1 - h0);
    const double y = hv * hv < 1 - 1e-12 ? hv * std::sqrt(d2 / (1 - hv * hv)) : view_.y1;
    return {x, std::clamp(y, view_.y0, view_.y1)};
}

}  // namespace sss
