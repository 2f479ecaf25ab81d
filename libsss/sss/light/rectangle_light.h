#pragma once
#include "sss/light/light.h"
#include "sss/light/spherical_rectangle.h"
#include "sss/scene/scene.h"

namespace sss {

/// A rectangle of constant radiance, sampled uniformly in solid angle: its irradiance has little
/// noise even close up. The width lies across `up`, the height along it.
class RectangleLightSource final : public Light {
public:
    RectangleLightSource(const RectangleLight& settings, const DVec3& originMm);
    LightSample sample(const Vec3& from, const Vec2& u) const override;
    /// In float where that is within 1e-6, in double elsewhere.
    void sampleTogether(std::span<const Vec3> from, std::span<const Vec2> u,
                        std::span<LightSample> samples) const override;
    Seen seen(const Vec3& from, const Vec3& direction) const override;
    Bounds visibleBounds() const override;
    bool isBelow(const Vec3& point, const Vec3& normal) const override;
    std::optional<Vec3> centre() const override { return Vec3(centre_); }
    float importance(const Bounds& target) const override;

private:
    /// The rectangle's centre from `from`, along its axes; z < 0 in front of it.
    DVec3 centreFrom(const Vec3& from) const;
    bool shinesOn(const DVec3& centreLocal) const {
        return centreLocal.z < 0 || (twoSided_ && centreLocal.z > 0);
    }
    RectangleView viewOf(const DVec3& centreLocal) const;
    /// Density at the point (x, y) of the rectangle as seen from the origin of `view`.
    double pdf(const RectangleView& view, double solidAngle, const DVec2& point) const;

    DVec3 centre_;
    DVec3 across_, up_, normal_;
    double halfWidth_, halfHeight_;
    float reach2_;  ///< squared distance from the centre to a corner
    Rgb radiance_;
    bool twoSided_;
};

}  // namespace sss
