#pragma once
#include "sss/base/distribution.h"
#include "sss/light/light.h"
#include "sss/volume/volume.h"

#include <optional>

namespace sss {

/// What a glowing volume is as a light: directions towards places in it, chosen in proportion to
/// what each cell of its grid emits. The emission along the whole direction is what a sample stands
/// for, not that of the place [Simon, Hanika, Zirr, Dachsbacher 2017, "Line Integration for
/// Rendering Heterogeneous Emissive Volumes"], so sample() gives radiance 1 and the integrator
/// collects the emission up to where the ray is stopped; likewise seen() is empty.
class VolumeLight final : public Light {
public:
    /// `index` of the volume in its world; `volume` outlives the light and glows.
    VolumeLight(const Volume& volume, int index);

    LightSample sample(const Vec3& from, const Vec2& u) const override;
    Seen seen(const Vec3&, const Vec3&) const override { return {}; }
    int volume() const override { return index_; }
    bool isBelow(const Vec3& point, const Vec3& normal) const override;
    std::optional<Vec3> centre() const override { return centre_; }
    float importance(const Bounds& target) const override;
    /// Density (sr^-1) at `from` with which sample() makes a direction.
    float pdf(const Vec3& from, const Vec3& direction) const;

private:
    const Volume& volume_;
    int index_;
    std::optional<PiecewiseConstant1D> choice_;  ///< of a cell
    double perCellMm3_;                          ///< 1 over the volume of a cell
    double intensity_ = 0;  ///< W m^-2 sr^-1 mm^2, mean over the channels, without absorption
    Vec3 centre_;           ///< of what it emits
};

}  // namespace sss
