#include "sss/light/point_light.h"

#include "sss/light/geometry.h"

namespace sss {

PointLightSource::PointLightSource(const PointLight& settings, const DVec3& originMm)
    : position_(settings.position - originMm), intensity_(DRgb(settings.intensity) * kMm2PerM2) {}

LightSample PointLightSource::sample(const Vec3& from, const Vec2&) const {
    const DVec3 offset = position_ - DVec3(from);
    const double distance2 = glm::dot(offset, offset);
    if (!(distance2 > 0)) return {};
    const double distance = std::sqrt(distance2);
    return {Vec3(offset / distance), static_cast<float>(distance),
            Rgb(DRgb(intensity_) / distance2), 1.0f};
}

float PointLightSource::importance(const Bounds& target) const {
    const double distance2 = importanceDistanceSquared(position_, target);
    return static_cast<float>(static_cast<double>(meanComponent(intensity_)) / distance2);
}

}  // namespace sss
