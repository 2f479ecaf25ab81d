#include "sss/cloud/diffusion_sum.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

constexpr int kMostRounds = 8;
// Receivers whose bounds are taken together: fewer see the near nodes more exactly, more share the
// walk through the tree.
constexpr std::uint32_t kReceiversPerLeaf = 8;
// A leaf sums over every point that is about as near as its receivers are to each other. Where the
// points are far denser than the receivers, that is more than each would need for itself.
constexpr float kMostSpacingsPerLeaf = 4.0f;
// A threshold that fits the whole group is this many shares of its darkest leaf at most: bounds are
// added in quadrature because they are many, not a few large ones.
constexpr double kLooseShare = 2.0;
// Opening rule of the estimate: node radius against distance.
constexpr float kCoarseOpening = 0.6f;
constexpr std::uint32_t kRoot = 0;

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
      mostLeafRadius_(nodes.empty() || cloud.size() == 0
                          ? 0.0f
                          : kMostSpacingsPerLeaf * std::sqrt(nodes[kRoot].areaMm2 /
                                                             static_cast<float>(cloud.size()))) {}

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
        const float size = node.radius();
        if (node.isLeaf() || size * size < kCoarseOpening * kCoarseOpening * distanceSquared) {
            sum += DRgb(node.flux * table_.evaluate(distanceSquared));
        } else {
            for (std::uint32_t k = 0; k < node.size(); ++k) stack.push_back(node.first + k);
        }
    }
    return sum;
}

void DiffusionSum::open(const OctreeNode& node, CandidateList& fresh, Scratch& scratch,
                        SumCounts& counts) const {
    for (std::uint32_t k = 0; k < node.size(); ++k) {
        const std::uint32_t i = node.first + k;
        if (!node.isLeaf())
            fresh.add(nodes_[i], i);
        else if (const Rgb flux = cloud_.flux(i); !isZero(flux))
            scratch.points.addPoint(cloud_.points[i].position, flux);
        else
            ++counts.pointsSkipped;
    }
}

ErrorBound DiffusionSum::gather(const CellTest& cell, const CandidateList& from,
                                CandidateList* pending, Scratch& scratch, SumCounts& counts) const {
    InteractionList& whole = pending ? scratch.locals : scratch.nodes;
    scratch.points.clear();
    whole.clear();
    if (pending) pending->clear();
    ErrorBound error;
    const CandidateList* now = &from;
    for (std::size_t level = 0; !now->empty(); ++level) {
        CandidateList& fresh = scratch.fresh[level % 2];
        fresh.clear();
        for (const CandidateList::Block& block : now->blocks()) {
            counts.nodesVisited += block.count;
            const Verdict verdict = judge(table_, block, cell, error);
            for (std::uint32_t i = 0; i < block.count; ++i) {
                if ((verdict.dark >> i) & 1) {
                    ++counts.nodesSkipped;
                    continue;
                }
                const OctreeNode& node = nodes_[block.node[i]];
                if ((verdict.taken >> i) & 1)
                    whole.addNode(node);
                else if (pending && (node.isLeaf() || block.radius[i] < cell.radius))
                    pending->add(block, i);
                else
                    open(node, fresh, scratch, counts);
            }
        }
        now = &fresh;
    }
    whole.pad();
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
    CandidateList& pending = scratch.pending[from.depth];
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
    const CandidateList* left = from.left;
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
    scratch.root.add(nodes_[kRoot], kRoot);

    const ReceiverCell& all = scratch.cells.front();
    Goal goal{tolerance, Rgb(0)};
    if (tolerance > 0) goal.threshold = Rgb(estimate(all, scratch, counts) * nodeShare(tolerance));
    descend(all, {&scratch.root, {.centre = all.centre}, {}, goal, 0}, scratch, counts);
    for (std::size_t k = 0; k < receivers.size(); ++k)
        out[scratch.order[k]] = Rgb(glm::max(scratch.sums[k], DRgb(0)));
}

DRgb DiffusionSum::bruteForce(const Vec3& receiver) const {
    DRgb sum{0};
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
        const Vec3 d = cloud_.points[i].position - receiver;
        sum += DRgb(cloud_.flux(i)) * DRgb(table_.evaluate(glm::dot(d, d)));
    }
    return sum;
}

}  // namespace sss
