#include "sss/scene/interpolation.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

/// The segment of a time and how far along it is, in [0, 1].
struct Segment {
    std::size_t from = 0;
    double along = 0;
};

Segment segmentAt(std::span<const double> times, double time) {
    if (times.size() < 2 || time <= times.front()) return {};
    if (time >= times.back()) return {times.size() - 2, 1.0};
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    const auto from = static_cast<std::size_t>(after - times.begin()) - 1;
    return {from, (time - times[from]) / (times[from + 1] - times[from])};
}

/// Slope at key `k`: the weighted harmonic mean of its neighbours' slopes, or none where they
/// differ in sign; at the ends the one there is.
double slopeAt(std::span<const double> t, std::span<const double> v, std::size_t k) {
    const auto secant = [&](std::size_t i) { return (v[i + 1] - v[i]) / (t[i + 1] - t[i]); };
    if (k == 0) return secant(0);
    if (k + 1 == t.size()) return secant(k - 1);
    const double before = secant(k - 1), after = secant(k);
    if (!(before * after > 0)) return 0;
    const double h0 = t[k] - t[k - 1], h1 = t[k + 1] - t[k];
    const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
    return (w0 + w1) / (w0 / before + w1 / after);
}

double dot(const Quaternion& a, const Quaternion& b) { return a.w * b.w + glm::dot(a.v, b.v); }
Quaternion scaled(const Quaternion& q, double by) { return {q.w * by, q.v * by}; }
Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - glm::dot(a.v, b.v), a.w * b.v + b.w * a.v + glm::cross(a.v, b.v)};
}

/// The great circle from a to b, normalised.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double u) {
    const double cosine = std::clamp(dot(a, b), -1.0, 1.0), angle = std::acos(cosine);
    const double sine = std::sin(angle);
    const bool isShort = sine < 1e-9;
    const double wa = isShort ? 1 - u : std::sin((1 - u) * angle) / sine;
    const double wb = isShort ? u : std::sin(u * angle) / sine;
    const Quaternion q{wa * a.w + wb * b.w, wa * a.v + wb * b.v};
    return scaled(q, 1 / std::sqrt(dot(q, q)));
}

/// Log of a unit quaternion: half its angle along its axis.
DVec3 logOf(const Quaternion& q) {
    const double sine = glm::length(q.v);
    return sine > 1e-12 ? q.v * (std::atan2(sine, q.w) / sine) : q.v;
}

Quaternion expOf(const DVec3& v) {
    const double angle = glm::length(v);
    return {std::cos(angle), v * (angle > 1e-12 ? std::sin(angle) / angle : 1.0)};
}

/// Squad's inner control point of key `k`; the end keys are their own.
Quaternion innerPoint(std::span<const Quaternion> q, std::size_t k) {
    if (k == 0 || k + 1 == q.size()) return q[k];
    const Quaternion inverse{q[k].w, -q[k].v};
    const DVec3 bend = logOf(product(inverse, q[k + 1])) + logOf(product(inverse, q[k - 1]));
    return product(q[k], expOf(bend * -0.25));
}

}  // namespace

double interpolate(std::span<const double> times, std::span<const double> values, double time,
                   Interpolation how) {
    const auto [k, u] = segmentAt(times, time);
    if (u == 0) return values[k];
    if (u == 1) return values[k + 1];
    if (how == Interpolation::Linear) return values[k] + (values[k + 1] - values[k]) * u;
    const double h = times[k + 1] - times[k];
    const double m0 = h * slopeAt(times, values, k), m1 = h * slopeAt(times, values, k + 1);
    // Cubic Hermite basis.
    const double rest = 1 - u;
    return values[k] * (1 + 2 * u) * rest * rest + m0 * u * rest * rest +
           values[k + 1] * u * u * (3 - 2 * u) - m1 * u * u * rest;
}

Quaternion quaternionOf(const DVec3& unitAxis, double radians) {
    return {std::cos(radians / 2), unitAxis * std::sin(radians / 2)};
}

Quaternion interpolate(std::span<const double> times, std::span<const Quaternion> values,
                       double time, Interpolation how) {
    const auto [k, u] = segmentAt(times, time);
    // All keys on the side of the one before: the shorter way.
    std::vector<Quaternion> q(values.begin(), values.end());
    for (std::size_t i = 1; i < q.size(); ++i)
        if (dot(q[i - 1], q[i]) < 0) q[i] = scaled(q[i], -1);
    if (u == 0) return q[k];
    if (u == 1) return q[k + 1];
    const Quaternion straight = slerp(q[k], q[k + 1], u);
    if (how == Interpolation::Linear) return straight;
    return slerp(straight, slerp(innerPoint(q, k), innerPoint(q, k + 1), u), 2 * u * (1 - u));
}

}  // namespace sss
