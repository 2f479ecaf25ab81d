#pragma once
#include "sss/light/light.h"
#include "sss/scene/scene.h"

namespace sss {

/// Parallel light from infinitely far.
class DirectionalLightSource final : public Light {
public:
    explicit DirectionalLightSource(const DirectionalLight& settings)
        : towardsLight_(-glm::normalize(settings.direction)), irradiance_(settings.irradiance) {}
    LightSample sample(const Vec3&, const Vec2&) const override {
        return {towardsLight_, std::numeric_limits<float>::infinity(), irradiance_, 1.0f};
    }
    bool isDelta() const override { return true; }
    bool isInfinite() const override { return true; }
    Seen seen(const Vec3&, const Vec3&) const override { return {}; }
    bool isBelow(const Vec3&, const Vec3& normal) const override {
        return glm::dot(towardsLight_, normal) <= 0;
    }
    float importance(const Bounds&) const override { return meanComponent(irradiance_); }

private:
    Vec3 towardsLight_;
    Rgb irradiance_;  ///< W m^-2 on a facing surface
};

}  // namespace sss
