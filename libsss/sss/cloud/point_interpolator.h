#pragma once
#include "sss/cloud/nearest_points.h"
#include "sss/cloud/point_cloud.h"
#include "sss/cloud/solved_exitance.h"

#include <span>
#include <vector>

namespace sss {

/// What is known at a cloud's points, anywhere on their surface: a plane fitted in the tangent
/// plane to the nearest points that face the same way, weighted by their distance (moving least
/// squares). Exact for what is linear along a flat part; smooths noise of single points by a factor
/// of about three; never leaves the range of its neighbours by more than a quarter of that range.
///
/// The exitance's own plane says how light leans. What is seen comes from one mean free path behind
/// the surface, along the line of sight inside: where exitance M falls along the surface, more is
/// seen by who looks from the side to which it falls. To first order that is -(mfp / eta) grad M .
/// w for the direction w outside, nothing on the mean over all azimuths [P1 theory, e.g. Ishimaru
/// 1978].
class PointInterpolator {
public:
    /// Not empty; both must outlive the interpolator.
    /// `leanMm`: mfp / eta by channel.
    PointInterpolator(std::span<const SurfacePoint> points, std::span<const SolvedExitance> values,
                      const Rgb& leanMm);
    /// Adds to `out[i]` the correction at places[i] (mm, on the surface), makes of the exitance
    /// that comes to what it would be along lines of sight that end within, and says how light
    /// leans there, unless `slopes` is empty. In the calling thread.
    void addTo(std::span<const Vec3> places, std::span<Rgb> out,
               std::span<ExitanceSlope> slopes = {}) const;

private:
    struct Fit {
        Rgb correction{0.0f}, collided{1.0f};
    };
    Fit fit(const Vec3& place, std::span<const std::uint32_t> near, ExitanceSlope* slope) const;

    std::span<const SurfacePoint> points_;
    std::span<const SolvedExitance> values_;
    Rgb leanMm_;
    std::vector<Vec3> positions_;
    NearestPoints nearest_;
};

}  // namespace sss
