#pragma once
#include "sss/base/vec.h"

#include <span>
#include <vector>

namespace sss {

/// Keys of an animated value: at least one; `times` rise strictly.
enum class Interpolation { Linear, Smooth };

/// One number a key. Smooth is the monotone cubic of Fritsch & Butland 1984 ("A method for
/// constructing local monotone piecewise cubic interpolants"): once differentiable, flat where the
/// keys turn, never beyond the keys next to it, so that what is keyed within a range stays in it.
/// Before the first and after the last key: theirs.
double interpolate(std::span<const double> times, std::span<const double> values, double time,
                   Interpolation how);

/// cos and axis * sin of half the angle of a rotation; q and -q are the same one.
struct Quaternion {
    double w = 1;
    DVec3 v{0};
};
Quaternion quaternionOf(const DVec3& unitAxis, double radians);

/// One unit quaternion a key; between keys the shorter way round. Smooth is Shoemake's squad
/// ("Quaternion calculus and fast animation", 1987).
Quaternion interpolate(std::span<const double> times, std::span<const Quaternion> values,
                       double time, Interpolation how);

}  // namespace sss
