#include "sss/shape/layer_sum.h"

#include "sss/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

namespace sss {
namespace {

// What one node may leave out of what all may: bounds have the worst direction at the nearest place
// and signs that change from node to node (layer_sum_test measures what is left: below a third).
constexpr float kNodeShare = 0.5f;
constexpr std::uint32_t kRoot = 0;

// A table's function of u = r^2 at a place: itself and its first two derivatives by u.
struct Radial {
    Rgb f, first, second;
};

Radial radialAt(const KernelTable& table, float distanceSquared) {
    const KernelTable::Place place = table.placeOf(distanceSquared);
    const float t = place.t, s = place.scale;
    Radial out;
    for (int c = 0; c < 3; ++c) {
        const auto at = [&](int power) { return place.row->c[power][c]; };
        out.f[c] = at(0) + t * (at(1) + t * (at(2) + t * at(3)));
        out.first[c] = s * (at(1) + t * (2.0f * at(2) + t * 3.0f * at(3)));
        out.second[c] = s * s * (2.0f * at(2) + t * 6.0f * at(3));
    }
    return out;
}

Rgb rgb(const float* lanes) { return {lanes[0], lanes[1], lanes[2]}; }

Rgb fromNode(const ChargeNode& node, const Vec3& d, const Radial& g) {
    const float weight[6] = {d.x * d.x,        d.y * d.y,        d.z * d.z,
                             2.0f * d.x * d.y, 2.0f * d.x * d.z, 2.0f * d.y * d.z};
    Rgb slope = rgb(node.quadrupole[0]) + rgb(node.quadrupole[1]) + rgb(node.quadrupole[2]);
    Rgb bend(0);
    for (int k = 0; k < 3; ++k) slope += rgb(node.dipole[k]) * d[k];
    for (int k = 0; k < 6; ++k) bend += rgb(node.quadrupole[k]) * weight[k];
    return rgb(node.charge) * g.f + 2.0f * slope * g.first + 4.0f * bend * g.second;
}

}  // namespace

void accumulateLayersScalar(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                            const Rgb& perLength, std::span<const Vec3> receivers,
                            std::span<DRgb> sums) {
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        for (const std::uint32_t n : list.nodes) {
            const Vec3 d = tree.shapes()[n].centre - receivers[r];
            sums[r] += DRgb(fromNode(tree.charges()[n], d, radialAt(green, glm::dot(d, d))));
        }
        for (const std::uint32_t i : list.points) {
            const Vec3 d = tree.cloud().points[i].position - receivers[r];
            const Radial g = radialAt(green, glm::dot(d, d));
            sums[r] += DRgb(tree.areaFluence(i) *
                            (g.f * perLength + 2.0f * glm::dot(tree.normal(i), d) * g.first));
        }
    }
}

LayerSum::LayerSum(const ChargeTree& tree, const KernelTable& green, const DRgb& perLength)
    : tree_(tree), green_(green), perLength_(perLength) {
    if (tree.nodes().empty()) return;
    std::vector<std::uint32_t> stack{kRoot};
    while (!stack.empty()) {
        const std::uint32_t n = stack.back();
        stack.pop_back();
        const OctreeNode& node = tree.nodes()[n];
        if (node.isLeaf() || tree.ranges()[n].size() <= kMostLayerReceivers) {
            cells_.push_back(n);
        } else {
            for (std::uint32_t k = 0; k < node.size(); ++k) stack.push_back(node.first + k);
        }
    }
}

void LayerSum::collect(std::size_t cell, const Rgb& allowed, LayerList& list,
                       std::vector<std::uint32_t>& stack) const {
    list.nodes.clear();
    list.points.clear();
    stack.assign(1, kRoot);
    const NodeShape& receivers = tree_.shapes()[cell];
    const Rgb limit = kNodeShare * allowed;
    while (!stack.empty()) {
        const std::uint32_t n = stack.back();
        stack.pop_back();
        const OctreeNode& node = tree_.nodes()[n];
        const NodeShape& shape = tree_.shapes()[n];
        const Vec3 d = shape.centre - receivers.centre;
        const float nearest = std::max(0.0f, glm::length(d) - shape.radius - receivers.radius);
        const Rgb bound = tree_.weights()[n] * green_.boundsAt(nearest * nearest).derivative[3] *
                          (perLength_ * (shape.thirdMean / 6.0f) + 0.5f * shape.secondMean);
        if (bound.x <= limit.x && bound.y <= limit.y && bound.z <= limit.z) {
            list.nodes.push_back(n);
        } else if (node.isLeaf()) {
            for (std::uint32_t k = 0; k < node.size(); ++k) list.points.push_back(node.first + k);
        } else {
            for (std::uint32_t k = 0; k < node.size(); ++k) stack.push_back(node.first + k);
        }
    }
}

void LayerSum::atPoints(std::span<const Rgb> allowed, std::span<DRgb> out,
                        LayerCounts& counts) const {
    ++counts.sums;
    std::mutex mutex;
    parallelFor(cells_.size(), 4, [&](std::size_t begin, std::size_t end) {
        LayerList list;
        std::vector<std::uint32_t> stack;
        std::vector<Vec3> places;
        LayerCounts own;
        for (std::size_t k = begin; k < end; ++k) {
            const PointRange& range = tree_.ranges()[cells_[k]];
            Rgb least = allowed[range.begin];
            for (std::uint32_t i = range.begin; i < range.end; ++i)
                least = glm::min(least, allowed[i]);
            collect(cells_[k], least, list, stack);
            // A leaf of points too close to tell apart may hold more than go at once.
            for (std::uint32_t i = range.begin; i < range.end;) {
                const std::uint32_t last =
                    std::min<std::uint32_t>(range.end, i + kMostLayerReceivers);
                places.clear();
                for (std::uint32_t p = i; p < last; ++p)
                    places.push_back(tree_.cloud().points[p].position);
                const std::span<DRgb> sums = out.subspan(i, last - i);
                std::fill(sums.begin(), sums.end(), DRgb(0));
                accumulateLayers(tree_, green_, list, perLength_, places, sums);
                i = last;
            }
            own.nodeInteractions += list.nodes.size() * range.size();
            own.pointInteractions += list.points.size() * range.size();
        }
        const std::scoped_lock lock(mutex);
        counts.nodeInteractions += own.nodeInteractions;
        counts.pointInteractions += own.pointInteractions;
    });
}

DRgb LayerSum::bruteForce(const Vec3& receiver) const {
    LayerList all;
    all.points.resize(tree_.cloud().size());
    std::iota(all.points.begin(), all.points.end(), 0u);
    DRgb sum{0};
    accumulateLayersScalar(tree_, green_, all, perLength_, std::span(&receiver, 1),
                           std::span(&sum, 1));
    return sum;
}

}  // namespace sss
