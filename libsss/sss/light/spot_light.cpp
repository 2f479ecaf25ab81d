#include "sss/light/spot_light.h"

#include "sss/light/geometry.h"
#include "sss/light/point_light.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sss {
namespace {

double cosDegrees(double degrees) { return std::cos(degrees * kPi / 180.0); }

}  // namespace

SpotLightSource::SpotLightSource(const SpotLight& settings, const DVec3& originMm)
    : position_(settings.position - originMm),
      axis_(glm::normalize(settings.lookAt - settings.position)),
      intensity_(DRgb(settings.intensity) * kMm2PerM2),
      cosOuter_(cosDegrees(settings.coneDegrees)),
      cosInner_(cosDegrees(std::max(0.0, settings.coneDegrees - settings.penumbraDegrees))) {}

double SpotLightSource::falloff(double cosine) const {
    if (cosine <= cosOuter_) return 0;
    if (cosine >= cosInner_) return 1;
    const double t = (cosine - cosOuter_) / (cosInner_ - cosOuter_);
    return t * t * (3 - 2 * t);
}

LightSample SpotLightSource::sample(const Vec3& from, const Vec2&) const {
    const DVec3 offset = position_ - DVec3(from);
    const double distance2 = glm::dot(offset, offset);
    if (!(distance2 > 0)) return {};
    const double distance = std::sqrt(distance2);
    const DVec3 direction = offset / distance;
    const double share = falloff(-glm::dot(direction, axis_));
    if (share <= 0) return {};
    return {Vec3(direction), static_cast<float>(distance),
            Rgb(DRgb(intensity_) * (share / distance2)), 1.0f};
}

// The cone is convex: what of a line lies in it is one piece, between roots of a quadratic.
Light::Stretch SpotLightSource::litStretch(const Vec3& origin, const Vec3& direction,
                                           const Stretch& within) const {
    const DVec3 w = DVec3(origin) - position_, d(direction);
    const double cos2 = cosOuter_ * cosOuter_, wa = glm::dot(w, axis_), da = glm::dot(d, axis_);
    const double a = da * da - cos2, b = wa * da - cos2 * glm::dot(w, d),
                 c = wa * wa - cos2 * glm::dot(w, w);
    std::array<double, 4> cuts{within.begin, within.end, within.end, within.end};
    std::size_t count = 1;
    const auto cut = [&](double t) {
        if (t > cuts[0] && t < static_cast<double>(within.end)) cuts[count++] = t;
    };
    if (const double rest = b * b - a * c; rest > 0 && a != 0) {
        // The root that does not cancel first, the other one by their product.
        const double q = -(b + std::copysign(std::sqrt(rest), b));
        cut(q / a);
        if (q != 0) cut(c / q);
    }
    std::sort(cuts.begin(), cuts.begin() + static_cast<std::ptrdiff_t>(count));
    cuts[count] = within.end;
    for (std::size_t k = 0; k < count; ++k) {
        const DVec3 middle = w + d * (0.5 * (cuts[k] + cuts[k + 1]));
        if (glm::dot(middle, axis_) > cosOuter_ * glm::length(middle))
            return {static_cast<float>(cuts[k]), static_cast<float>(cuts[k + 1])};
    }
    return {within.end, within.end};
}

float SpotLightSource::importance(const Bounds& target) const {
    const double distance2 = importanceDistanceSquared(position_, target);
    const double share = falloff(largestCosine(position_, axis_, target));
    return static_cast<float>(static_cast<double>(meanComponent(intensity_)) * share / distance2);
}

}  // namespace sss
