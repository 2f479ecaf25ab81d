#pragma once
#include "sss/cloud/nearest_points.h"
#include "sss/cloud/point_cloud.h"

#include <span>
#include <vector>

namespace sss {

/// A smooth quantity that is known at a cloud's points, anywhere on their surface: a plane fitted
/// in the tangent plane to the nearest points that face the same way, weighted by their distance
/// (moving least squares). Exact for what is linear along a flat part; smooths noise of single
/// points by a factor of about three; never leaves the range of its neighbours by more than a
/// quarter of that range.
class PointInterpolator {
public:
    /// Not empty; both must outlive the interpolator.
    PointInterpolator(std::span<const SurfacePoint> points, std::span<const Rgb> values);
    /// Adds to `out[i]` what is at places[i] (mm, on the surface). In the calling thread.
    void addTo(std::span<const Vec3> places, std::span<Rgb> out) const;

private:
    Rgb fit(const Vec3& place, std::span<const std::uint32_t> near) const;

    std::span<const SurfacePoint> points_;
    std::span<const Rgb> values_;
    std::vector<Vec3> positions_;
    NearestPoints nearest_;
};

}  // namespace sss
