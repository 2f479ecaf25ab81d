#pragma once
#include "sss/light/light.h"
#include "sss/scene/scene.h"

namespace sss {

/// A point light within a cone; the intensity falls from its value on the axis to 0 over the
/// penumbra, smoothly in the cosine (cubic).
class SpotLightSource final : public Light {
public:
    SpotLightSource(const SpotLight& settings, const DVec3& originMm);
    LightSample sample(const Vec3& from, const Vec2& u) const override;
    bool isDelta() const override { return true; }
    Seen seen(const Vec3&, const Vec3&) const override { return {}; }
    bool isBelow(const Vec3& point, const Vec3& normal) const override {
        return glm::dot(position_ - DVec3(point), DVec3(normal)) <= 0;
    }
    std::optional<Vec3> centre() const override { return Vec3(position_); }
    Stretch litStretch(const Vec3& origin, const Vec3& direction,
                       const Stretch& within) const override;
    float importance(const Bounds& target) const override;

private:
    double falloff(double cosine) const;
    DVec3 position_, axis_;
    Rgb intensity_;  ///< W sr^-1 on the axis, times kMm2PerM2
    double cosOuter_, cosInner_;
};

}  // namespace sss
