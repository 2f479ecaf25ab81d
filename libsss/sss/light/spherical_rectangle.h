#pragma once
#include "sss/base/vec.h"

namespace sss {

/// A rectangle seen from the origin: its corners have x in [x0, x1], y in [y0, y1], and z = -height
/// in a frame of the caller's, height > 0.
struct RectangleView {
    double x0, x1, y0, y1, height;
};

/// Uniform sampling of the solid angle of a rectangle [Urena, Fajardo, King 2013, "An
/// Area-Preserving Parametrization for Spherical Rectangles"], with their angles rewritten as
/// arctangents of x y / (z r), which do not cancel.
class SphericalRectangle {
public:
    explicit SphericalRectangle(const RectangleView& view);
    /// In sr, in [0, 2 pi).
    double solidAngle() const { return solidAngle_; }
    /// The point (x, y) on the rectangle.
    DVec2 sample(const DVec2& u) const;

private:
    RectangleView view_;
    double solidAngle_;
    double cosOffset_, sinOffset_;  ///< of k of the paper, less pi
    double b0_, b1_;                ///< z components of the normals of the planes through y0 and y1
};

}  // namespace sss
