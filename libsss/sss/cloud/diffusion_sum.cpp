#include "sss/cloud/diffusion_sum.h"

#include "sss/cloud/cloud_guard.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sss {
namespace {

// A round may lower a threshold to a fiftieth: as many as take it from the brightest to the darkest
// numbers of single precision. A leaf may be that much darker than the middle of its group.
constexpr int kMostRounds = 24;
// Receivers whose bounds are taken together: fewer see the near nodes more exactly, more share the
// walk through the tree.
constexpr std::uint32_t kReceiversPerLeaf = 8;
// A leaf sums over every point that is about as near as its receivers are to each other. Where the
// points are far denser than the receivers, that is more than each would need for itself.
constexpr float kMostSpacingsPerLeaf = 4.0f;
// Points far denser than what the profile tells apart are not taken one by one, and the walk to
// their nodes is worth sharing again: what a receiver costs ends to grow with the points.
constexpr float kMostHalfWidthsPerLeaf = 4.0f;
// A threshold that fits the whole group is this many shares of its darkest leaf at most: bounds are
// added in quadrature because they are many, not a few large ones.
constexpr double kLooseShare = 2.0;
// Opening rule of the estimate: node radius against distance.
constexpr float kCoarseOpening = 0.6f;
constexpr std::uint32_t kRoot = 0;

// Asks for memory that is read soon.
template <typename T>
void prefetch(std::span<const T> items) {
    constexpr std::size_t kCacheLine = 64;
    const auto* bytes = reinterpret_cast<const char*>(items.data());
    for (std::size_t i = 0; i < items.size_bytes(); i += kCacheLine) __builtin_prefetch(bytes + i);
}

float mostLeafRadius(const CloudView& cloud, std::span<const OctreeNode> nodes,
                     const KernelTable& table) {
    if (nodes.empty() || cloud.size() == 0) return 0.0f;
    const float spacing = std::sqrt(nodes[kRoot].areaMm2 / static_cast<float>(cloud.size()));
    return std::max(kMostSpacingsPerLeaf * spacing, kMostHalfWidthsPerLeaf * table.halfWidthMm());
}

bool allBelow(const DRgb& a, const DRgb& b) { return a.x <= b.x && a.y <= b.y && a.z <= b.z; }

}  // namespace

void SumCounts::add(const SumCounts& other) {
    receivers += other.receivers;
    localInteractions += other.localInteractions;
    nodeInteractions += other.nodeInteractions;
    pointInteractions += other.pointInteractions;
    nodesVisited += other.nodesVisited;
    nodesSkipped += other.nodesSkipped;
    pointsSkipped += other.pointsSkipped;
    groups += other.groups;
    repeats += other.repeats;
}

DiffusionSum::DiffusionSum(const CloudView& cloud, std::span<const OctreeNode> nodes,
                           const KernelTable& table)
    : cloud_(cloud),
      nodes_(nodes),
      table_(table),
      mostLeafRadius_(mostLeafRadius(cloud, nodes, table)) {}

void DiffusionSum::needNodes(std::uint32_t first, std::uint32_t count) const {
    if (cloud_.guard) cloud_.guard->needNodes(first, count);
}

void DiffusionSum::needPoints(std::uint32_t first, std::uint32_t count) const {
    if (cloud_.guard) cloud_.guard->needPoints(first, count);
}

DRgb DiffusionSum::estimate(const ReceiverCell& cell, Scratch& scratch, SumCounts& counts) const {
    DRgb sum{0};
    auto& stack = scratch.stack;
    stack.assign(1, kRoot);
    while (!stack.empty()) {
        const OctreeNode& node = nodes_[stack.back()];
        stack.pop_back();
        ++counts.nodesVisited;
        if (isZero(node.flux)) {
            ++counts.nodesSkipped;
            continue;
        }
        const Vec3 d = node.centroid - cell.centre;
        const float distanceSquared = glm::dot(d, d);
        const float size = node.radius;
        if (node.isLeaf() || size * size < kCoarseOpening * kCoarseOpening * distanceSquared) {
            sum += DRgb(node.flux * table_.evaluate(distanceSquared));
        } else {
            needNodes(node.first, node.size());
            for (std::uint32_t k = 0; k < node.size(); ++k) stack.push_back(node.first + k);
        }
    }
    return sum;
}

void DiffusionSum::addPoints(const OctreeNode& leaf, InteractionList& points,
                             SumCounts& counts) const {
    counts.pointsSkipped += points.addPoints(cloud_.points.subspan(leaf.first, leaf.size()),
                                             cloud_.irradiance.subspan(leaf.first, leaf.size()));
}

ErrorBound DiffusionSum::gather(const CellTest& cell, const NodeList& from, NodeList* pending,
                                Scratch& scratch, SumCounts& counts) const {
    scratch.points.clear();
    scratch.taken.clear();
    scratch.leaves.clear();
    if (pending) pending->clear();
    ErrorBound error;
    std::span<const std::uint32_t> now = from.indices();
    for (std::size_t level = 0; !now.empty(); ++level) {
        NodeList& fresh = scratch.fresh[level % 2];
        fresh.clear();
        counts.nodesVisited += now.size();
        while (!now.empty()) {
            const auto some = now.first(std::min(kMostJudged, now.size()));
            now = now.subspan(some.size());
            const Verdict verdict = judge(table_, nodes_, some, cell, error);
            counts.nodesSkipped += static_cast<std::uint64_t>(std::popcount(verdict.dark));
            scratch.taken.addWhere(verdict.taken, some);
            const std::uint64_t all = ~std::uint64_t{0} >> (kMostJudged - some.size());
            std::uint64_t left = all & ~(verdict.taken | verdict.dark);
            if (pending) {
                pending->addWhere(left & verdict.fine, some);
                left &= ~verdict.fine;
            }
            for (; left != 0; left &= left - 1) {
                const auto i = static_cast<std::size_t>(std::countr_zero(left));
                const OctreeNode& node = nodes_[some[i]];
                if (node.isLeaf()) {
                    needPoints(node.first, node.size());
                    scratch.leaves.addRun(some[i], 1);
                    prefetch(cloud_.points.subspan(node.first, node.size()));
                    prefetch(cloud_.irradiance.subspan(node.first, node.size()));
                } else {
                    needNodes(node.first, node.size());
                    fresh.addRun(node.first, node.size());
                    prefetch(nodes_.subspan(node.first, node.size()));
                }
            }
        }
        now = fresh.indices();
    }
    InteractionList& whole = pending ? scratch.locals : scratch.nodes;
    whole.setNodes(nodes_, scratch.taken.indices());
    whole.pad();
    for (const std::uint32_t i : scratch.leaves.indices())
        addPoints(nodes_[i], scratch.points, counts);
    scratch.points.pad();
    return error;
}

void DiffusionSum::descend(const ReceiverCell& cell, const Inherited& from, Scratch& scratch,
                           SumCounts& counts) const {
    if (cell.isLeaf()) {
        finish(cell, from, scratch, counts);
        return;
    }
    // A list for each depth: both halves read their parent's.
    if (scratch.pending.size() <= from.depth) scratch.pending.emplace_back();
    NodeList& pending = scratch.pending[from.depth];
    Inherited own{&pending, from.far.movedTo(cell.centre), from.error, from.goal, from.depth + 1};
    own.error.add(gather({cell.centre, cell.radius, cell.radius, from.goal.threshold}, *from.left,
                         &pending, scratch, counts));
    counts.localInteractions += scratch.locals.size();
    accumulate(table_, scratch.locals, own.far);
    for (std::uint32_t k = 0; k < 2; ++k)
        descend(scratch.cells[cell.child + k], own, scratch, counts);
}

void DiffusionSum::finish(const ReceiverCell& leaf, const Inherited& from, Scratch& scratch,
                          SumCounts& counts) const {
    const std::span<const Vec3> receivers =
        std::span(scratch.ordered).subspan(leaf.begin, leaf.size());
    const std::span<DRgb> sums = std::span(scratch.sums).subspan(leaf.begin, leaf.size());
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = from.far.at(receivers[i]);
    ErrorBound bound = from.error;
    const NodeList* left = from.left;
    CellTest cell{leaf.centre, leaf.radius, 0.0f, from.goal.threshold};
    for (int round = 0; round < kMostRounds; ++round) {
        bound.add(gather(cell, *left, nullptr, scratch, counts));
        accumulate(table_, scratch.nodes, true, receivers, sums);
        accumulate(table_, scratch.points, false, receivers, sums);
        counts.nodeInteractions += scratch.nodes.size() * leaf.size();
        counts.pointInteractions += scratch.points.size() * leaf.size();
        DRgb least = sums.front();
        for (const DRgb& sum : sums) least = glm::min(least, sum);
        least = glm::max(least, DRgb(0));
        const DRgb allowed = least * from.goal.tolerance;
        const DRgb error = bound.total() * DRgb(cell.threshold);
        const DRgb share = least * nodeShare(from.goal.tolerance);
        const DRgb over = DRgb(cell.threshold) - kLooseShare * share;
        if ((allBelow(error, allowed) && allBelow(over, DRgb(0))) || round + 1 == kMostRounds)
            break;
        // All anew, aiming at the bound with a little to spare.
        for (int c = 0; c < 3; ++c) {
            double factor = 1;
            if (error[c] > allowed[c]) factor = 0.7 * allowed[c] / error[c];
            if (over[c] > 0) factor = std::min(factor, share[c] / double{cell.threshold[c]});
            if (factor < 1) cell.threshold[c] *= static_cast<float>(std::clamp(factor, 0.02, 0.7));
        }
        ++counts.repeats;
        std::fill(sums.begin(), sums.end(), DRgb(0));
        bound = {};
        left = &scratch.root;
    }
}

void DiffusionSum::evaluate(std::span<const Vec3> receivers, double tolerance, std::span<Rgb> out,
                            Scratch& scratch, SumCounts& counts) const {
    std::fill(out.begin(), out.end(), Rgb(0));
    if (nodes_.empty() || receivers.empty()) return;
    counts.receivers += receivers.size();
    ++counts.groups;
    buildReceiverTree(receivers, kReceiversPerLeaf, mostLeafRadius_, scratch.cells, scratch.order);
    scratch.ordered.clear();
    for (const std::uint32_t i : scratch.order) scratch.ordered.push_back(receivers[i]);
    scratch.sums.assign(receivers.size(), DRgb(0));
    scratch.root.clear();
    scratch.root.addRun(kRoot, 1);

    const ReceiverCell& all = scratch.cells.front();
    Goal goal{tolerance, Rgb(0)};
    if (tolerance > 0) goal.threshold = Rgb(estimate(all, scratch, counts) * nodeShare(tolerance));
    descend(all, {&scratch.root, {.centre = all.centre}, {}, goal, 0}, scratch, counts);
    for (std::size_t k = 0; k < receivers.size(); ++k)
        out[scratch.order[k]] = Rgb(glm::max(scratch.sums[k], DRgb(0)));
}

DRgb DiffusionSum::bruteForce(const Vec3& receiver) const {
    DRgb sum{0};
    cloud_.needAll();
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
        const Vec3 d = cloud_.points[i].position - receiver;
        sum += DRgb(cloud_.flux(i)) * DRgb(table_.evaluate(glm::dot(d, d)));
    }
    return sum;
}

}  // namespace sss
