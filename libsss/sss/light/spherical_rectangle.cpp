#include "sss/light/spherical_rectangle.h"

#include <algorithm>

namespace sss {
namespace {

/// A complex number whose argument is an angle: the sum of angles is the argument of the product,
/// so that many arctangents become one.
struct Turn {
    double re, im;
};
Turn difference(const Turn& a, const Turn& b) {
    return {a.re * b.re + a.im * b.im, a.im * b.re - a.re * b.im};
}

/// Its argument is the signed solid angle of the rectangle from the foot of the perpendicular to
/// the corner (x, y): atan(x y / (h r)).
Turn cornerAngle(double x, double y, double height) {
    return {height * std::sqrt(x * x + y * y + height * height), x * y};
}

}  // namespace

SphericalRectangle::SphericalRectangle(const RectangleView& view) : view_(view) {
    const double h = view.height;
    const Turn a00 = cornerAngle(view.x0, view.y0, h), a01 = cornerAngle(view.x0, view.y1, h);
    const Turn a10 = cornerAngle(view.x1, view.y0, h), a11 = cornerAngle(view.x1, view.y1, h);
    const Turn upper = difference(a11, a01), lower = difference(a10, a00);
    const Turn whole = difference(upper, lower);
    solidAngle_ = std::atan2(whole.im, whole.re);
    // More than half a turn, or rounding below none: each side's own angle is less than half.
    if (!(solidAngle_ >= 0))
        solidAngle_ =
            std::max(0.0, std::atan2(upper.im, upper.re) - std::atan2(lower.im, lower.re));
    const double side0 = std::sqrt(h * h + view.y0 * view.y0);
    const double side1 = std::sqrt(h * h + view.y1 * view.y1);
    const Turn offset = difference(a01, a00);
    // |cornerAngle|^2 = (x^2 + h^2) (y^2 + h^2).
    const double length = (view.x0 * view.x0 + h * h) * side0 * side1;
    cosOffset_ = offset.re / length;
    sinOffset_ = offset.im / length;
    b0_ = -view.y0 / side0;
    b1_ = view.y1 / side1;
}

DVec2 SphericalRectangle::sample(const DVec2& u) const {
    // x from the share of the solid angle to its left; sine and cosine of the paper's angle au
    // change sign with pi taken out of k.
    const double part = u.x * solidAngle_;
    const double cosPart = std::cos(part), sinPart = std::sin(part);
    const double sinAngle = sinPart * cosOffset_ + cosPart * sinOffset_;
    const double cosAngle = cosPart * cosOffset_ - sinPart * sinOffset_;
    const double f = (cosAngle * b0_ + b1_) / sinAngle;
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
