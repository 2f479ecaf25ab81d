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

// From how deep on the mean the light comes that a line of sight sees which ends within by this
// share, in mean free paths: 1 where that is all.
Rgb meanDepth(const Rgb& collided) {
    Rgb depth(1);
    for (int c = 0; c < 3; ++c) {
        const float straight = 1.0f - collided[c];
        if (straight > 1e-6f) depth[c] += straight * std::log(straight) / collided[c];
    }
    return depth;
}

}  // namespace

PointInterpolator::PointInterpolator(std::span<const SurfacePoint> points,
                                     std::span<const SolvedExitance> values, const Rgb& leanMm)
    : points_(points),
      values_(values),
      leanMm_(leanMm),
      positions_(positionsOf(points)),
      nearest_(positions_) {}

PointInterpolator::Fit PointInterpolator::fit(const Vec3& place,
                                              std::span<const std::uint32_t> near,
                                              ExitanceSlope* slope) const {
    const Vec3 normal = decodeUnitVector(points_[near.front()].normal);
    const Frame frame(normal);
    double area = 0;
    for (const std::uint32_t i : near) area += points_[i].areaMm2;
    const double spread = kWidth * kWidth * area / static_cast<double>(near.size());
    // Sums of w, w u, w v, w uu, w uv, w vv, and of these with the values.
    DMat3 moments(0.0);
    DRgb ones{0}, us{0}, vs{0};
    DRgb allOnes{0}, allUs{0}, allVs{0};  // of the exitance
    DRgb collided{0};
    Rgb lo = values_[near.front()].correction, hi = lo;
    for (const std::uint32_t i : near) {
        const float facing = glm::dot(normal, decodeUnitVector(points_[i].normal));
        if (facing <= 0) continue;
        const Vec3 d = points_[i].position - place;
        const double w =
            double{facing} * std::exp(-0.5 * static_cast<double>(glm::dot(d, d)) / spread);
        const Vec3 local = frame.toLocal(d);
        const DVec3 basis(1.0, local.x, local.y);
        moments += w * glm::outerProduct(basis, basis);
        const DRgb value(values_[i].correction), all(values_[i].thickExitance);
        ones += w * value;
        us += w * basis.y * value;
        vs += w * basis.z * value;
        allOnes += w * all;
        allUs += w * basis.y * all;
        allVs += w * basis.z * all;
        collided += w * DRgb(values_[i].collided);
        lo = glm::min(lo, values_[i].correction);
        hi = glm::max(hi, values_[i].correction);
    }
    const double total = moments[0][0];
    if (!(total > 0)) return {values_[near.front()].correction, values_[near.front()].collided};
    Rgb value(ones / total);
    const Rgb share(collided / total);
    if (glm::determinant(moments) > kFlat * total * total * total * spread * spread) {
        // Value at the place itself and slopes along the frame: rows of the inverse, which is
        // symmetric.
        const DMat3 inverse = glm::inverse(moments);
        const auto solved = [&](int row, const DRgb& one, const DRgb& u, const DRgb& v) {
            return Rgb(inverse[row].x * one + inverse[row].y * u + inverse[row].z * v);
        };
        value = solved(0, ones, us, vs);
        if (slope != nullptr) {
            const Rgb reach = leanMm_ * meanDepth(share);
            const Rgb u = reach * solved(1, allOnes, allUs, allVs),
                      v = reach * solved(2, allOnes, allUs, allVs);
            const Vec3 alongU = frame.toWorld({1, 0, 0}), alongV = frame.toWorld({0, 1, 0});
            *slope = {-(u * alongU.x + v * alongV.x), -(u * alongU.y + v * alongV.y),
                      -(u * alongU.z + v * alongV.z)};
        }
    }
    const Rgb margin = kOvershoot * (hi - lo);
    return {glm::clamp(value, lo - margin, hi + margin), share};
}

void PointInterpolator::addTo(std::span<const Vec3> places, std::span<Rgb> out,
                              std::span<ExitanceSlope> slopes) const {
    const std::size_t count = std::min(kNeighbours, points_.size());
    std::vector<std::uint32_t> near;
    for (std::size_t begin = 0; begin < places.size(); begin += NearestPoints::kBatch) {
        const auto batch =
            places.subspan(begin, std::min(NearestPoints::kBatch, places.size() - begin));
        near.resize(batch.size() * count);
        nearest_.query(batch, count, near);
        for (std::size_t i = 0; i < batch.size(); ++i) {
            const Fit here = fit(batch[i], std::span(near).subspan(i * count, count),
                                 slopes.empty() ? nullptr : &slopes[begin + i]);
            Rgb& value = out[begin + i];
            value = (value + here.correction) / here.collided;
        }
    }
}

}  // namespace sss
