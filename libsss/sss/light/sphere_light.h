#pragma once
#include "sss/light/light.h"
#include "sss/scene/scene.h"

namespace sss {

/// A sphere of constant radiance that shines outwards, sampled uniformly in the cone in which it is
/// seen. From inside there is nothing to see.
class SphereLightSource final : public Light {
public:
    SphereLightSource(const SphereLight& settings, const DVec3& originMm);
    LightSample sample(const Vec3& from, const Vec2& u) const override;
    Seen seen(const Vec3& from, const Vec3& direction) const override;
    Bounds visibleBounds() const override {
        Bounds box;
        box.add(Vec3(centre_ - radius_));
        box.add(Vec3(centre_ + radius_));
        return box;
    }
    bool isBelow(const Vec3& point, const Vec3& normal) const override {
        return glm::dot(centre_ - DVec3(point), DVec3(normal)) <= -radius_;
    }
    std::optional<Vec3> centre() const override { return Vec3(centre_); }
    float importance(const Bounds& target) const override;

private:
    /// 1 - cos of the cone's half angle from a point outside; without cancellation far away.
    double coneHeight(double distance2) const;
    DVec3 centre_;
    double radius_;
    Rgb radiance_;
};

}  // namespace sss
