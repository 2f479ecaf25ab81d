#include "sss/cloud/octree.h"

#include "sss/base/parallel.h"
#include "sss/base/parallel_sort.h"
#include "sss/cloud/morton.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <numeric>
#include <tuple>

namespace sss {
namespace {

constexpr double kRoundedUp = 1 + 1e-7;   // so that no point is outside
constexpr std::size_t kLargeNodes = 512;  // the root and about three levels below

struct Range {
    std::uint32_t begin, end;
    int shift;  // the children differ in code bits [shift, shift + 3)
};

Bounds boundsOf(std::span<const SurfacePoint> points) {
    Bounds box;
    for (const SurfacePoint& p : points) box.add(p.position);
    return box;
}

// Adds the children of a range: runs of equal 3-bit digits at the highest digit in which the range
// differs. Codes ascend, so that a run's end is found by halving. Returns how many.
std::uint32_t split(const Range range, std::span<const std::uint64_t> codes,
                    std::vector<Range>& to) {
    const std::uint64_t difference = codes[range.begin] ^ codes[range.end - 1];
    if (difference == 0) return 0;
    int shift = range.shift;
    while ((difference >> shift) == 0) shift -= 3;
    std::uint32_t children = 0;
    const auto last = codes.begin() + range.end;
    for (auto begin = codes.begin() + range.begin; begin != last; ++children) {
        const std::uint64_t digit = *begin >> shift;
        const auto end = std::partition_point(
            begin, last, [&](std::uint64_t code) { return (code >> shift) == digit; });
        to.push_back({static_cast<std::uint32_t>(begin - codes.begin()),
                      static_cast<std::uint32_t>(end - codes.begin()), shift - 3});
        begin = end;
    }
    return children;
}

// Moments of one weight (a channel or the mean) about the node's centroid.
struct Moments {
    double weight = 0;
    DVec3 first{0};
    std::array<double, 6> second{};
    double third = 0;

    void add(double w, const DVec3& d) {
        weight += w;
        first += w * d;
        const std::array<double, 6> dd{d.x * d.x, d.y * d.y, d.z * d.z,
                                       d.x * d.y, d.x * d.z, d.y * d.z};
        for (std::size_t k = 0; k < 6; ++k) second[k] += w * dd[k];
        const double lengthSquared = dd[0] + dd[1] + dd[2];
        third += w * lengthSquared * std::sqrt(lengthSquared);
    }
};

double tensorNorm(const std::array<double, 6>& t) {
    return std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] +
                     2.0 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]));
}

void summarise(OctreeNode& node, const CloudView& cloud, const Range& range) {
    DVec3 fluxSum{0}, weighted{0}, areaWeighted{0};
    double area = 0;
    Bounds box;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        const SurfacePoint& p = cloud.points[i];
        const DVec3 flux = DVec3(cloud.irradiance[i]) * static_cast<double>(p.areaMm2);
        const double mean = (flux.x + flux.y + flux.z) / 3.0;
        fluxSum += flux;
        weighted += mean * DVec3(p.position);
        area += p.areaMm2;
        areaWeighted += static_cast<double>(p.areaMm2) * DVec3(p.position);
        box.add(p.position);
    }
    const double total = (fluxSum.x + fluxSum.y + fluxSum.z) / 3.0;
    const DVec3 centroid =
        total > 0 ? weighted / total : (area > 0 ? areaWeighted / area : DVec3(box.centre()));
    node.centroid = glm::clamp(Vec3(centroid), box.lo, box.hi);
    node.flux = Rgb(fluxSum);
    node.areaMm2 = static_cast<float>(area);
    double farthest = 0;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        const DVec3 d = DVec3(cloud.points[i].position) - DVec3(node.centroid);
        farthest = std::max(farthest, glm::dot(d, d));
    }
    node.radius = static_cast<float>(std::sqrt(farthest) * kRoundedUp);
    if (!(total > 0)) return;

    Moments mean;
    std::array<Moments, 3> channels;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        const DVec3 d = DVec3(cloud.points[i].position) - DVec3(node.centroid);
        const DVec3 flux = DVec3(cloud.flux(i));
        mean.add((flux.x + flux.y + flux.z) / 3.0, d);
        for (int c = 0; c < 3; ++c) channels[static_cast<std::size_t>(c)].add(flux[c], d);
    }
    for (std::size_t k = 0; k < 6; ++k)
        node.moments[k] = static_cast<float>(mean.second[k] / mean.weight);
    // Under white light all channels lie where the mean lies, which is the centroid but for
    // rounding.
    std::array<DVec3, 3> leans;
    double lean = 0, moment = 0, third = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const Moments& m = channels[c];
        leans[c] = (m.first - mean.first * (m.weight / mean.weight)) / mean.weight;
        lean = std::max(lean, glm::length(leans[c]));
        if (!(m.weight > 0)) continue;
        third = std::max(third, m.third / m.weight);
        std::array<double, 6> difference;
        for (std::size_t k = 0; k < 6; ++k)
            difference[k] = m.second[k] / m.weight - mean.second[k] / mean.weight;
        moment = std::max(moment, tensorNorm(difference));
    }
    // Rounding is not colour: under white light both are 0.
    constexpr double kRounding = 1e-9;
    const double extent = std::cbrt(third);
    if (lean > kRounding * extent) {
        node.lean[0] = Vec3(leans[0]);
        node.lean[1] = Vec3(leans[2]);
    }
    node.chromaticMoment = moment > kRounding * extent * extent ? static_cast<float>(moment) : 0.0f;
    node.cubicMean = static_cast<float>(extent);
}

// `tie` orders what lies at one place; it is a total order.
template <typename Tie>
std::vector<std::uint32_t> orderOf(std::span<const Vec3> positions, const Tie& tie) {
    Bounds box;
    for (const Vec3& p : positions) box.add(p);
    const MortonGrid grid(box);
    std::vector<std::uint64_t> codes(positions.size());
    parallelFor(positions.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) codes[i] = grid.code(positions[i]);
    });
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    parallelSort(std::span(order), [&](std::uint32_t a, std::uint32_t b) {
        const Vec3 &p = positions[a], &q = positions[b];
        const auto left = std::tie(codes[a], p.x, p.y, p.z);
        const auto right = std::tie(codes[b], q.x, q.y, q.z);
        return left < right || (left == right && tie(a, b));
    });
    return order;
}

}  // namespace

std::vector<std::uint32_t> mortonOrder(std::span<const Vec3> positions) {
    return orderOf(positions, std::less<>());
}

std::vector<std::uint32_t> cloudOrder(const CloudView& cloud) {
    std::vector<Vec3> positions;
    positions.reserve(cloud.size());
    for (const SurfacePoint& point : cloud.points) positions.push_back(point.position);
    return orderOf(positions, [&](std::uint32_t a, std::uint32_t b) {
        int order = std::memcmp(&cloud.points[a], &cloud.points[b], sizeof(SurfacePoint));
        if (order == 0 && !cloud.irradiance.empty())
            order = std::memcmp(&cloud.irradiance[a], &cloud.irradiance[b], sizeof(Rgb));
        return order != 0 ? order < 0 : a < b;
    });
}

std::vector<OctreeNode> buildOctree(const CloudView& cloud) {
    std::vector<OctreeNode> nodes;
    if (cloud.size() == 0) return nodes;
    const MortonGrid grid(boundsOf(cloud.points));
    std::vector<std::uint64_t> codes(cloud.size());
    parallelFor(cloud.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) codes[i] = grid.code(cloud.points[i].position);
    });

    std::vector<Range> ranges{{0, static_cast<std::uint32_t>(cloud.size()), 3 * (kMortonBits - 1)}};
    for (std::size_t n = 0; n < ranges.size(); ++n) {
        const Range range = ranges[n];
        OctreeNode node;
        const std::uint32_t size = range.end - range.begin;
        node.first = static_cast<std::uint32_t>(ranges.size());
        node.count = size > kLeafPoints ? split(range, codes, ranges) : 0;
        if (node.count == 0) {
            node.first = range.begin;
            node.count = OctreeNode::kLeaf | size;
        }
        nodes.push_back(node);
    }
    // The first nodes hold most of the points each: one at a time, so that no thread gets them all.
    const std::size_t large = std::min(nodes.size(), kLargeNodes);
    const auto summariseFrom = [&](std::size_t first, std::size_t count, std::size_t grain) {
        parallelFor(count, grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = first + begin; n < first + end; ++n)
                summarise(nodes[n], cloud, ranges[n]);
        });
    };
    summariseFrom(0, large, 1);
    summariseFrom(large, nodes.size() - large, 64);
    return nodes;
}

}  // namespace sss
