#include "sss/cloud/octree_check.h"

#include "sss/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>

namespace sss {
namespace {

constexpr std::size_t kGrain = 1 << 14;

// mm. Squares of distances between places within this stay finite in single precision: what the sum
// looks up by them stays in its table.
constexpr float kFarthest = 1e18f;

// 0 for finite numbers, NaN for others: no branch in the loops below.
float excess(float value) { return value * 0.0f; }
float excess(const Vec3& v) { return v.x * 0.0f + v.y * 0.0f + v.z * 0.0f; }

bool isLight(const Rgb& v) { return excess(v) == 0.0f && v.x >= 0 && v.y >= 0 && v.z >= 0; }

bool isNear(const Vec3& p) {
    return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

bool isSound(const SurfacePoint& p) {
    return isNear(p.position) && excess(p.areaMm2) == 0.0f && p.areaMm2 >= 0;
}

bool isSound(const OctreeNode& node) {
    float sum = excess(node.areaMm2) + excess(node.chromaticOffset) + excess(node.chromaticMoment) +
                excess(node.cubicMean);
    for (const float moment : node.moments) sum += excess(moment);
    return sum == 0.0f && node.areaMm2 >= 0 && isLight(node.flux) && isNear(node.centroid) &&
           isNear(node.lo) && isNear(node.hi);
}

template <typename Test>
bool allOf(std::size_t count, const Test& test) {
    std::atomic<bool> all{true};
    parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        bool sound = true;
        for (std::size_t i = begin; i < end; ++i) sound &= test(i);
        if (!sound) all = false;
    });
    return all;
}

// Every node but the root is the next child of the next inner node.
bool isTree(std::span<const OctreeNode> nodes, std::size_t pointCount) {
    if (nodes.empty()) return pointCount == 0;
    std::uint64_t nextChild = 1, points = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const OctreeNode& node = nodes[n];
        if (node.isLeaf()) {
            if (std::uint64_t{node.first} + node.size() > pointCount) return false;
            points += node.size();
        } else {
            if (node.first != nextChild || node.first <= n || node.size() == 0) return false;
            nextChild += node.size();
        }
    }
    return nextChild == nodes.size() && points == pointCount;
}

}  // namespace

bool isSound(const CloudView& cloud, std::span<const OctreeNode> nodes) {
    const std::size_t count = cloud.points.size();
    return cloud.irradiance.size() == count && isTree(nodes, count) &&
           allOf(count,
                 [&](std::size_t i) {
                     return isSound(cloud.points[i]) && isLight(cloud.irradiance[i]);
                 }) &&
           allOf(nodes.size(), [&](std::size_t i) { return isSound(nodes[i]); });
}

}  // namespace sss
