#pragma once
#include "sss/base/distribution.h"
#include "sss/image/rgb_map.h"
#include "sss/light/light.h"
#include "sss/scene/scene.h"

namespace sss {

/// The same radiance from everywhere, sampled uniformly over the sphere.
class ConstantEnvironment final : public Light {
public:
    explicit ConstantEnvironment(const Rgb& radiance) : radiance_(radiance) {}
    LightSample sample(const Vec3& from, const Vec2& u) const override;
    bool isInfinite() const override { return true; }
    bool bestFoundByScattering() const override { return true; }
    bool isUniform() const override { return true; }
    Seen seen(const Vec3& from, const Vec3& direction) const override;
    float importance(const Bounds&) const override { return kPiF * meanComponent(radiance_); }

private:
    Rgb radiance_;
};

/// A latitude-longitude map in OpenEXR's convention: +y at the top, +z in the middle of the
/// picture, +x in the middle of its left half. Looked up bilinearly, and sampled by the average of
/// that over each pixel, times its solid angle, over a floor that no direction falls below.
class MapEnvironment final : public Light {
public:
    /// `scale` multiplies the map; it is turned by `rotationDegrees` about +y (from +z to +x).
    MapEnvironment(RgbMap map, const Rgb& scale, double rotationDegrees);
    LightSample sample(const Vec3& from, const Vec2& u) const override;
    bool isInfinite() const override { return true; }
    Seen seen(const Vec3& from, const Vec3& direction) const override;
    float importance(const Bounds&) const override { return importance_; }

private:
    Rgb radianceAt(const Vec2& position) const;
    float solidAnglePdf(const Vec2& position, float squarePdf) const;
    RgbMap map_;
    float rotation_;  ///< radian
    PiecewiseConstant2D distribution_;
    float importance_;
};

/// A map if `settings` names one (see readExr and rgbMap for the errors), else constant.
std::unique_ptr<Light> makeEnvironment(const EnvironmentLight& settings);

}  // namespace sss
