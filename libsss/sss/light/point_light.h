#pragma once
#include "sss/light/light.h"
#include "sss/scene/scene.h"

namespace sss {

/// Square millimetres in a square metre: W sr^-1 over mm^2 is this many W m^-2.
inline constexpr double kMm2PerM2 = 1e6;

/// Light from one point, the same in all directions: irradiance I / d^2 on a facing surface.
class PointLightSource final : public Light {
public:
    /// Positions of `settings` are relative to the world; the light's are relative to `originMm`.
    PointLightSource(const PointLight& settings, const DVec3& originMm);
    LightSample sample(const Vec3& from, const Vec2& u) const override;
    bool isDelta() const override { return true; }
    Seen seen(const Vec3&, const Vec3&) const override { return {}; }
    bool isBelow(const Vec3& point, const Vec3& normal) const override {
        return glm::dot(position_ - DVec3(point), DVec3(normal)) <= 0;
    }
    std::optional<Vec3> centre() const override { return Vec3(position_); }
    float importance(const Bounds& target) const override;

private:
    DVec3 position_;
    Rgb intensity_;  ///< W sr^-1, times kMm2PerM2
};

}  // namespace sss
