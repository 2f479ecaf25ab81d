#pragma once
#include "sss/base/distribution.h"
#include "sss/light/light.h"

#include <array>
#include <vector>

namespace sss {

/// Emitting triangles of one radiance, in the scene's space; the right-hand rule gives the side
/// that shines. Sampled uniformly by area. A ray hits them as geometry, so seen() is empty and the
/// integrator asks radianceTowards() and pdfForHit() where it hits one.
class MeshLight final : public Light {
public:
    using Triangle = std::array<Vec3, 3>;
    struct Emission {
        Rgb radiance{1.0f};
        bool twoSided = false;
    };
    /// At least one triangle; those without area are never chosen.
    MeshLight(std::vector<Triangle> triangles, const Emission& emission);

    LightSample sample(const Vec3& from, const Vec2& u) const override;
    Seen seen(const Vec3&, const Vec3&) const override { return {}; }
    bool isBelow(const Vec3& point, const Vec3& normal) const override;
    std::optional<Vec3> centre() const override { return bounds_.centre(); }
    float importance(const Bounds& target) const override;

    /// Radiance that leaves a face of unit normal `faceNormal` (right-hand rule) against a ray that
    /// arrived in `direction`.
    Rgb radianceTowards(const Vec3& direction, const Vec3& faceNormal) const;
    /// Density (sr^-1) at `from` with which sample() makes the direction to `hitPoint`, a point on
    /// a face of unit normal `faceNormal`; 0 from the dark side.
    float pdfForHit(const Vec3& from, const Vec3& hitPoint, const Vec3& faceNormal) const;
    double areaMm2() const { return choice_.total(); }

private:
    std::vector<Triangle> triangles_;
    Emission emission_;
    PiecewiseConstant1D choice_;  ///< by area
    Bounds bounds_;
};

}  // namespace sss
