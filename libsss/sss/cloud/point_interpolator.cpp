#include "sss/cloud/point_interpolator.h"

#include "sss/base/warp.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

constexpr std::size_t kNeighbours = 16;
// Standard deviation of the weights, in spacings of the points about.
constexpr float kWidth = 0.8f;
constexpr float kOvershoot = 0.25f;
// Of the fit's determinant to that of equally spread neighbours: below, they lie along a line.
constexpr double kFlat = 1e-4;

std::vector<Vec3> positionsOf(std::span<const SurfacePoint> points) {
    std::vector<Vec3> positions;
    positions.reserve(points.size());
    for (const SurfacePoint& p : points) positions.push_back(p.position);
    return positions;
}

}  // namespace

PointInterpolator::PointInterpolator(std::span<const SurfacePoint> points,
                                     std::span<const Rgb> values)
    : points_(points), values_(values), positions_(positionsOf(points)), nearest_(positions_) {}

Rgb PointInterpolator::fit(const Vec3& place, std::span<const std::uint32_t> near) const {
    const Vec3 normal = decodeUnitVector(points_[near.front()].normal);
    const Frame frame(normal);
    double area = 0;
    for (const std::uint32_t i : near) area += points_[i].areaMm2;
    const double spread = kWidth * kWidth * area / static_cast<double>(near.size());
    // Sums of w, w u, w v, w uu, w uv, w vv, and of these with the values.
    DMat3 moments(0.0);
    DRgb ones{0}, us{0}, vs{0};
    Rgb lo = values_[near.front()], hi = lo;
    for (const std::uint32_t i : near) {
        const float facing = glm::dot(normal, decodeUnitVector(points_[i].normal));
        if (facing <= 0) continue;
        const Vec3 d = points_[i].position - place;
        const double w =
            double{facing} * std::exp(-0.5 * static_cast<double>(glm::dot(d, d)) / spread);
        const Vec3 local = frame.toLocal(d);
        const DVec3 basis(1.0, local.x, local.y);
        moments += w * glm::outerProduct(basis, basis);
        const DRgb value(values_[i]);
        ones += w * value;
        us += w * basis.y * value;
        vs += w * basis.z * value;
        lo = glm::min(lo, values_[i]);
        hi = glm::max(hi, values_[i]);
    }
    const double total = moments[0][0];
    if (!(total > 0)) return values_[near.front()];
    Rgb value(ones / total);
    if (glm::determinant(moments) > kFlat * total * total * total * spread * spread) {
        // Value at the place itself: first row of the inverse, which is symmetric.
        const DVec3 row = glm::inverse(moments)[0];
        value = Rgb(row.x * ones + row.y * us + row.z * vs);
    }
    const Rgb margin = kOvershoot * (hi - lo);
    return glm::clamp(value, lo - margin, hi + margin);
}

void PointInterpolator::addTo(std::span<const Vec3> places, std::span<Rgb> out) const {
    const std::size_t count = std::min(kNeighbours, points_.size());
    std::vector<std::uint32_t> near;
    for (std::size_t begin = 0; begin < places.size(); begin += NearestPoints::kBatch) {
        const auto batch =
            places.subspan(begin, std::min(NearestPoints::kBatch, places.size() - begin));
        near.resize(batch.size() * count);
        nearest_.query(batch, count, near);
        for (std::size_t i = 0; i < batch.size(); ++i)
            out[begin + i] += fit(batch[i], std::span(near).subspan(i * count, count));
    }
}

}  // namespace sss
