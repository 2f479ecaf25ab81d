#include "sss/shape/layer_sum.h"

#include "sss/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>
#include <numeric>

namespace sss {
namespace {

// What one node may leave out of what all may: bounds have the worst direction at the nearest place
// and signs that change from node to node (layer_sum_test measures what is left: below a third).
constexpr float kNodeShare = 0.5f;
// Points below the nodes that threads share among them.
constexpr std::uint32_t kMostInGroup = 1024;
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

void expand(const ChargeNode& node, const Vec3& d, const Radial& g, LocalExpansion& to) {
    const Rgb charge = rgb(node.charge);
    const Rgb p[3] = {rgb(node.dipole[0]), rgb(node.dipole[1]), rgb(node.dipole[2])};
    const Rgb along = p[0] * d.x + p[1] * d.y + p[2] * d.z;
    to.value += DRgb(fromNode(node, d, g));
    // d shrinks as the receiver goes along it.
    const Rgb bend = 4.0f * g.second, slope = 2.0f * g.first;
    for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        to.gradient[axis] -= DRgb(slope * (charge * d[k] + p[k]) + bend * along * d[k]);
        to.hessian[axis] += DRgb(charge * (slope + bend * (d[k] * d[k])));
    }
    to.hessian[3] += DRgb(charge * bend * (d.x * d.y));
    to.hessian[4] += DRgb(charge * bend * (d.x * d.z));
    to.hessian[5] += DRgb(charge * bend * (d.y * d.z));
}

}  // namespace

void expandLayersScalar(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                        LocalExpansion& expansion) {
    for (const std::uint32_t n : list.locals) {
        const Vec3 d = tree.shapes()[n].centre - expansion.centre;
        expand(tree.charges()[n], d, radialAt(green, glm::dot(d, d)), expansion);
    }
}

void accumulateLayersScalar(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                            std::span<const Vec3> receivers, std::span<DRgb> sums) {
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        for (const std::uint32_t n : list.nodes) {
            const Vec3 d = tree.shapes()[n].centre - receivers[r];
            sums[r] += DRgb(fromNode(tree.charges()[n], d, radialAt(green, glm::dot(d, d))));
        }
        for (const std::uint32_t i : list.points) {
            const Vec3 d = tree.cloud().points[i].position - receivers[r];
            const Radial g = radialAt(green, glm::dot(d, d));
            sums[r] += DRgb(tree.charge(i) * g.f +
                            tree.areaFluence(i) * (2.0f * glm::dot(tree.normal(i), d) * g.first));
        }
    }
}

void LayerCounts::add(const LayerCounts& other) {
    sums += other.sums;
    localInteractions += other.localInteractions;
    nodeInteractions += other.nodeInteractions;
    pointInteractions += other.pointInteractions;
}

LayerSum::LayerSum(const ChargeTree& tree, const KernelTable& green, const DRgb& perLength)
    : tree_(tree), green_(green), perLength_(perLength) {
    if (tree.nodes().empty()) return;
    std::vector<std::uint32_t> stack{kRoot};
    while (!stack.empty()) {
        const std::uint32_t n = stack.back();
        stack.pop_back();
        const OctreeNode& node = tree.nodes()[n];
        if (node.isLeaf() || tree.ranges()[n].size() <= kMostInGroup) {
            groups_.push_back(n);
        } else {
            for (std::uint32_t k = 0; k < node.size(); ++k) stack.push_back(node.first + k);
        }
    }
}

// What one thread needs, and where its answers go.
struct LayerSum::Walk {
    std::span<const Rgb> least;  // by node: what may be missed at any point below
    std::span<DRgb> out;
    LayerList list;
    std::deque<std::vector<std::uint32_t>> pending;  // left to a cell's children, by depth
    std::size_t depth = 0;
    std::vector<std::uint32_t> stack;
    std::vector<Vec3> places;
    LayerCounts counts;
};

bool LayerSum::isSmall(std::size_t n) const {
    return tree_.nodes()[n].isLeaf() || tree_.ranges()[n].size() <= kMostLayerReceivers;
}

std::vector<Rgb> LayerSum::leastBelow(std::span<const Rgb> allowed) const {
    std::vector<Rgb> least(tree_.nodes().size());
    for (std::size_t n = least.size(); n-- > 0;) {  // children stand behind their parents
        const OctreeNode& node = tree_.nodes()[n];
        const std::span<const Rgb> below = node.isLeaf() ? allowed : std::span<const Rgb>(least);
        least[n] = below[node.first];
        for (std::uint32_t k = 1; k < node.size(); ++k)
            least[n] = glm::min(least[n], below[node.first + k]);
    }
    return least;
}

void LayerSum::descend(std::size_t cell, const LocalExpansion& above,
                       std::span<const std::uint32_t> left, Walk& walk) const {
    const NodeShape& receivers = tree_.shapes()[cell];
    const bool isLast = isSmall(cell);
    const Rgb limit = kNodeShare * walk.least[cell];
    if (walk.pending.size() <= walk.depth) walk.pending.emplace_back();
    std::vector<std::uint32_t>& pending = walk.pending[walk.depth];
    LayerList& list = walk.list;
    list.locals.clear();
    list.nodes.clear();
    list.points.clear();
    pending.clear();
    walk.stack.assign(left.begin(), left.end());
    while (!walk.stack.empty()) {
        const std::uint32_t n = walk.stack.back();
        walk.stack.pop_back();
        if (isZero(tree_.weights()[n])) continue;
        const OctreeNode& node = tree_.nodes()[n];
        const NodeShape& shape = tree_.shapes()[n];
        const float nearest = std::max(
            0.0f, glm::length(shape.centre - receivers.centre) - shape.radius - receivers.radius);
        const Rgb third = tree_.weights()[n] * green_.boundsAt(nearest * nearest).derivative[3];
        // By the third power of the distance from the centres for charges, by the second for
        // dipoles; a receiver's own distance counts where the cell is taken as one.
        const auto isBelow = [&](float second, float cubed) {
            const Rgb bound = third * (perLength_ * (cubed / 6.0f) + 0.5f * second);
            return bound.x <= limit.x && bound.y <= limit.y && bound.z <= limit.z;
        };
        const float reach = shape.extent + receivers.radius;
        if (isBelow(reach * reach, reach * reach * reach)) {
            list.locals.push_back(n);
        } else if (isLast && isBelow(shape.secondMean, shape.thirdMean)) {
            list.nodes.push_back(n);
        } else if (!isLast && (node.isLeaf() || shape.radius < receivers.radius)) {
            pending.push_back(n);
        } else {
            for (std::uint32_t k = 0; k < node.size(); ++k)
                (node.isLeaf() ? list.points : walk.stack).push_back(node.first + k);
        }
    }
    LocalExpansion far = above.movedTo(receivers.centre);
    expandLayers(tree_, green_, list, far);
    walk.counts.localInteractions += list.locals.size();
    if (isLast) {
        finish(cell, far, walk);
        return;
    }
    ++walk.depth;
    const OctreeNode& node = tree_.nodes()[cell];
    for (std::uint32_t k = 0; k < node.size(); ++k) descend(node.first + k, far, pending, walk);
    --walk.depth;
}

void LayerSum::finish(std::size_t cell, const LocalExpansion& far, Walk& walk) const {
    const PointRange& range = tree_.ranges()[cell];
    // A leaf of points too close to tell apart may hold more than go at once.
    for (std::uint32_t i = range.begin; i < range.end;) {
        const std::uint32_t last = std::min<std::uint32_t>(range.end, i + kMostLayerReceivers);
        walk.places.clear();
        for (std::uint32_t p = i; p < last; ++p) {
            walk.places.push_back(tree_.cloud().points[p].position);
            walk.out[p] = far.at(walk.places.back());
        }
        accumulateLayers(tree_, green_, walk.list, walk.places, walk.out.subspan(i, last - i));
        i = last;
    }
    walk.counts.nodeInteractions += walk.list.nodes.size() * range.size();
    walk.counts.pointInteractions += walk.list.points.size() * range.size();
}

void LayerSum::atPoints(std::span<const Rgb> allowed, std::span<DRgb> out,
                        LayerCounts& counts) const {
    ++counts.sums;
    const std::vector<Rgb> least = leastBelow(allowed);
    std::mutex mutex;
    parallelFor(groups_.size(), 1, [&](std::size_t begin, std::size_t end) {
        Walk walk{least, out, {}, {}, 0, {}, {}, {}};
        for (std::size_t k = begin; k < end; ++k) {
            const LocalExpansion none{.centre = tree_.shapes()[groups_[k]].centre};
            descend(groups_[k], none, std::span(&kRoot, 1), walk);
        }
        const std::scoped_lock lock(mutex);
        counts.add(walk.counts);
    });
}

DRgb LayerSum::bruteForce(const Vec3& receiver) const {
    LayerList all;
    all.points.resize(tree_.cloud().size());
    std::iota(all.points.begin(), all.points.end(), 0u);
    DRgb sum{0};
    accumulateLayersScalar(tree_, green_, all, std::span(&receiver, 1), std::span(&sum, 1));
    return sum;
}

}  // namespace sss
