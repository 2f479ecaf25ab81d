#include "sss/light/spot_light.h"

#include "sss/light/geometry.h"
#include "sss/light/point_light.h"

#include <algorithm>

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

float SpotLightSource::importance(const Bounds& target) const {
    const double distance2 = importanceDistanceSquared(position_, target);
    const double share = falloff(largestCosine(position_, axis_, target));
    return static_cast<float>(static_cast<double>(meanComponent(intensity_)) * share / distance2);
}

}  // namespace sss
