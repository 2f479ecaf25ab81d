#include "sss/cloud/octree_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sss {
namespace {

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

bool areNumbersSound(const OctreeNode& node) {
    float sum = excess(node.areaMm2) + excess(node.chromaticMoment) + excess(node.cubicMean);
    for (const float moment : node.moments) sum += excess(moment);
    return sum == 0.0f && node.areaMm2 >= 0 && isLight(node.flux) && isNear(node.centroid) &&
           node.radius >= 0 && node.radius <= 4.0f * kFarthest && isNear(node.lean[0]) &&
           isNear(node.lean[1]);
}

// No branch, so that the loop runs at the speed of memory.
template <typename T, typename Test>
bool allOf(std::span<const T> items, const Test& test) {
    bool all = true;
    for (const T& item : items) all &= test(item);
    return all;
}

void pass(const OctreeNode& node, NodesBefore& before) {
    (node.isLeaf() ? before.points : before.children) += node.size();
}

}  // namespace

std::vector<NodesBefore> nodesBefore(std::span<const OctreeNode> nodes, unsigned shift) {
    std::vector<NodesBefore> parts;
    NodesBefore before;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (n >> shift == parts.size()) parts.push_back(before);
        pass(nodes[n], before);
    }
    return parts;
}

bool isSound(std::span<const NodesBefore> parts, const OctreeSize& size) {
    if (parts.empty()) return size.nodes == 0 && size.points == 0;
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (size.nodes > kMost || size.points > kMost) return false;
    NodesBefore before;
    if (parts.front() != before) return false;
    for (const NodesBefore& part : parts) {
        if (part.children < before.children || part.points < before.points) return false;
        before = part;
    }
    return before.children <= size.nodes && before.points <= size.points;
}

bool isSound(std::span<const OctreeNode> nodes, std::size_t first, NodesBefore before,
             const NodesBefore& after, const OctreeSize& size) {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const OctreeNode& node = nodes[n];
        // Every node but the root is the next child of the next inner node.
        const bool isPlaced =
            node.isLeaf() ? std::uint64_t{node.first} + node.size() <= size.points &&
                                node.size() <= after.points - before.points
                          : node.first == before.children && node.first > first + n &&
                                node.size() > 0 && node.size() <= after.children - before.children;
        if (!isPlaced) return false;
        pass(node, before);
    }
    return before == after && allOf(nodes, areNumbersSound);
}

bool areSound(std::span<const SurfacePoint> points) {
    return allOf(points, [](const SurfacePoint& p) { return isSound(p); });
}

bool areSound(std::span<const Rgb> irradiance) { return allOf(irradiance, isLight); }

}  // namespace sss
