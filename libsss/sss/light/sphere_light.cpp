#include "sss/light/sphere_light.h"

#include "sss/light/geometry.h"

namespace sss {

SphereLightSource::SphereLightSource(const SphereLight& settings, const DVec3& originMm)
    : centre_(settings.centre - originMm),
      radius_(settings.radiusMm),
      radiance_(settings.radiance) {}

double SphereLightSource::coneHeight(double distance2) const {
    const double sin2 = radius_ * radius_ / distance2;
    return sin2 / (1 + std::sqrt(1 - sin2));
}

LightSample SphereLightSource::sample(const Vec3& from, const Vec2& u) const {
    const DVec3 offset = centre_ - DVec3(from);
    const double distance2 = glm::dot(offset, offset);
    if (!(distance2 > radius_ * radius_)) return {};
    const double distance = std::sqrt(distance2);
    const double height = coneHeight(distance2);

    const double h = height * static_cast<double>(u.x);  // 1 - cos
    const double sin2 = h * (2 - h);
    const double angle = 2 * kPi * static_cast<double>(u.y);
    const Frame frame(Vec3(offset / distance));
    const Vec3 local{
        DVec3{std::sqrt(sin2) * std::cos(angle), std::sqrt(sin2) * std::sin(angle), 1 - h}};
    const double toSurface =
        distance * (1 - h) - std::sqrt(std::max(0.0, radius_ * radius_ - distance2 * sin2));
    return {glm::normalize(frame.toWorld(local)), static_cast<float>(std::max(0.0, toSurface)),
            radiance_, static_cast<float>(1 / (2 * kPi * height))};
}

Light::Seen SphereLightSource::seen(const Vec3& from, const Vec3& direction) const {
    const DVec3 offset = centre_ - DVec3(from);
    const double distance2 = glm::dot(offset, offset);
    if (!(distance2 > radius_ * radius_)) return {};
    const DVec3 d = glm::normalize(DVec3(direction));
    const double along = glm::dot(offset, d);
    const DVec3 aside = offset - along * d;
    const double inside2 = radius_ * radius_ - glm::dot(aside, aside);
    if (along <= 0 || inside2 < 0) return {};
    return {radiance_, static_cast<float>(1 / (2 * kPi * coneHeight(distance2))),
            static_cast<float>(along - std::sqrt(inside2))};
}

float SphereLightSource::importance(const Bounds& target) const {
    const double distance2 =
        std::max(importanceDistanceSquared(centre_, target), radius_ * radius_);
    return meanComponent(radiance_) * static_cast<float>(kPi * radius_ * radius_ / distance2);
}

}  // namespace sss
