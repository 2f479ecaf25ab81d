#include "sss/volume/volume_region.h"

#include <algorithm>
#include <cmath>

namespace sss {

RayInterval clipToUnitCube(const UnitLine& line, double end) {
    RayInterval inside{0, end};
    for (int axis = 0; axis < 3; ++axis) {
        const double o = line.origin[axis], d = line.direction[axis];
        if (d == 0) {
            if (o < 0 || o > 1) return {0, 0};
            continue;
        }
        const double a = -o / d, b = (1 - o) / d;
        inside.begin = std::max(inside.begin, std::min(a, b));
        inside.end = std::min(inside.end, std::max(a, b));
    }
    return inside;
}

RayInterval clipToUnitBall(const UnitLine& line, double end) {
    const DVec3 o = line.origin - 0.5;
    const double a = glm::dot(line.direction, line.direction);
    const double middle = -glm::dot(o, line.direction) / a;
    const DVec3 nearest = o + line.direction * middle;
    const double rest = (0.25 - glm::dot(nearest, nearest)) / a;
    if (!(rest > 0)) return {0, 0};
    const double half = std::sqrt(rest);
    return {std::max(0.0, middle - half), std::min(end, middle + half)};
}

MeshInterior::MeshInterior(const TriangleMesh& mesh) {
    std::vector<Vec3> positions;
    for (const DVec3& p : mesh.positions) positions.emplace_back(p);
    const RayScene::Geometry geometry{positions, mesh.faces};
    rays_ = std::make_unique<RayScene>(std::span(&geometry, 1));
}

void MeshInterior::clip(const Vec3& origin, const Vec3& direction, double end,
                        std::vector<RayInterval>& inside) const {
    constexpr int kMostCrossings = 10000;  // a guard against rays that do not get on
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    double entered = 0;
    Hit hit;
    for (int k = 0; k < kMostCrossings && rays_->intersect(ray, hit); ++k) {
        const auto t = static_cast<double>(hit.t);
        const bool isLeaving = glm::dot(hit.normal, direction) > 0;
        // What it leaves first it started in.
        if (isLeaving && entered < std::min(t, end)) inside.push_back({entered, std::min(t, end)});
        if (t >= end) return;
        entered = isLeaving ? std::numeric_limits<double>::infinity() : t;
        ray.tMin = hit.t + rays_->place(hit).step;
    }
}

}  // namespace sss
