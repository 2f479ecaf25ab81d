#include "sss/cloud/diffusion_sum.h"

#include "sss/base/bounds.h"
#include "sss/cloud/receiver_clusters.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

// What a node leaves out is bounded by the worst direction at the nearest place; true remainders
// are of third order with changing signs and add up to a small part of the sum of their bounds.
// That sum may therefore be this much above the tolerance: the most with which single receivers,
// whose bounds are the tightest, keep errors within the tolerance and biases within a tenth of it
// (diffusion_sum_test: half-lit and two-coloured bodies, marble, skim milk and ketchup, tolerances
// 0.1 to 0.0001).
constexpr double kBoundSlack = 8.0;
// Differences between the channels' moments have the same sign over whole regions (red light here,
// blue there) and hardly cancel: they weigh this much more, so that they get no slack.
constexpr float kChromaticWeight = 10.0f;
// First guess of how many nodes share the error, at 1 %; the finer the sum the more, about by the
// fourth root of the tolerance (measured on the bunny). Where it is wrong, the shares adapt.
constexpr double kFirstShares = 100.0;
// A node that adds less than this share of the threshold is left out. Leaving out is always dark,
// so it must not add up to a bias: all that is left out stays below 1e-5 of the tolerance or so.
constexpr float kNegligibleShare = 1e-6f;
constexpr int kMostRounds = 8;
// Receivers whose bounds are taken together: fewer see the near nodes more exactly, more share the
// walk through the tree.
constexpr std::size_t kReceiversPerCluster = 8;
// Opening rule of the estimate: node radius against distance.
constexpr float kCoarseOpening = 0.6f;

Bounds boundsOf(std::span<const Vec3> points) {
    Bounds box;
    for (const Vec3& p : points) box.add(p);
    return box;
}

bool allBelow(const DRgb& a, const DRgb& b) { return a.x <= b.x && a.y <= b.y && a.z <= b.z; }

}  // namespace

void SumCounts::add(const SumCounts& other) {
    receivers += other.receivers;
    nodeInteractions += other.nodeInteractions;
    pointInteractions += other.pointInteractions;
    nodesVisited += other.nodesVisited;
    traversals += other.traversals;
}

DiffusionSum::DiffusionSum(const CloudView& cloud, std::span<const OctreeNode> nodes,
                           const KernelTable& table)
    : cloud_(cloud), nodes_(nodes), table_(table) {}

DRgb DiffusionSum::estimate(const Group& group, Scratch& scratch, SumCounts& counts) const {
    DRgb sum{0};
    auto& stack = scratch.stack;
    stack.assign(1, 0);
    while (!stack.empty()) {
        const OctreeNode& node = nodes_[stack.back()];
        stack.pop_back();
        ++counts.nodesVisited;
        if (isZero(node.flux)) continue;
        const Vec3 d = node.centroid - group.centre;
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

void DiffusionSum::gatherLeaf(const OctreeNode& node, Scratch& scratch) const {
    for (std::uint32_t i = node.first; i < node.first + node.size(); ++i) {
        const Rgb flux = cloud_.flux(i);
        if (!isZero(flux)) scratch.points.addPoint(cloud_.points[i].position, flux);
    }
}

DRgb DiffusionSum::gather(const Group& group, const Rgb& threshold,
                          std::span<const std::uint32_t> from, std::vector<std::uint32_t>* pending,
                          Scratch& scratch, SumCounts& counts) const {
    scratch.nodes.clear();
    scratch.points.clear();
    ++counts.traversals;
    DRgb error{0};
    auto& stack = scratch.stack;
    stack.assign(from.begin(), from.end());
    while (!stack.empty()) {
        const std::uint32_t index = stack.back();
        const OctreeNode& node = nodes_[index];
        stack.pop_back();
        ++counts.nodesVisited;
        if (isZero(node.flux)) continue;
        const float distance = glm::length(node.centroid - group.centre), size = node.radius();
        const float nearest = std::max(0.0f, distance - group.radius - size);
        const KernelTable::BoundsRow& bound = table_.boundsAt(nearest * nearest);
        const Rgb most = node.flux * bound.derivative[0];
        if (glm::all(glm::lessThanEqual(most, threshold * kNegligibleShare))) {
            error += DRgb(most);
            continue;
        }
        const Rgb chromatic = node.chromaticMoment * 0.5f * bound.derivative[2] +
                              node.chromaticOffset * bound.derivative[1];
        const Rgb left = node.flux * (node.thirdMoment * (1.0f / 6.0f) * bound.derivative[3] +
                                      kChromaticWeight * chromatic);
        if (glm::all(glm::lessThanEqual(left, threshold))) {
            error += DRgb(left);
            scratch.nodes.addNode(node);
        } else if (pending && size < group.radius) {
            pending->push_back(index);
        } else if (node.isLeaf()) {
            gatherLeaf(node, scratch);
        } else {
            for (std::uint32_t k = 0; k < node.size(); ++k) stack.push_back(node.first + k);
        }
    }
    scratch.nodes.pad();
    scratch.points.pad();
    return error;
}

void DiffusionSum::addLists(std::span<const Vec3> receivers, std::span<DRgb> sums, Scratch& scratch,
                            SumCounts& counts) const {
    accumulate(table_, scratch.nodes, true, receivers, sums);
    accumulate(table_, scratch.points, false, receivers, sums);
    counts.nodeInteractions += scratch.nodes.size() * receivers.size();
    counts.pointInteractions += scratch.points.size() * receivers.size();
}

DiffusionSum::Group DiffusionSum::groupAround(std::span<const Vec3> receivers) {
    const Bounds box = boundsOf(receivers);
    Group group{box.centre(), 0.0f};
    for (const Vec3& p : receivers)
        group.radius = std::max(group.radius, glm::length(p - group.centre));
    return group;
}

void DiffusionSum::evaluateCluster(std::span<const Vec3> receivers, double tolerance,
                                   const Shared& shared, Scratch& scratch,
                                   SumCounts& counts) const {
    const Group cluster = groupAround(receivers);
    Rgb threshold = shared.threshold;
    constexpr std::uint32_t kRoot = 0;
    for (int round = 0; round < kMostRounds; ++round) {
        // First what the group has left over; where the bounds then miss, the cluster on its own.
        const bool isFirst = round == 0;
        DRgb error = isFirst ? shared.error : DRgb(0);
        if (isFirst)
            scratch.sums.assign(shared.sums.begin(), shared.sums.end());
        else
            scratch.sums.assign(receivers.size(), DRgb(0));
        error += gather(cluster, threshold, isFirst ? scratch.pending : std::span(&kRoot, 1),
                        nullptr, scratch, counts);
        addLists(receivers, scratch.sums, scratch, counts);
        DRgb least = scratch.sums.front();
        for (const DRgb& sum : scratch.sums) least = glm::min(least, sum);
        if (allBelow(error, least * (tolerance * kBoundSlack))) break;
        // Aim at the bound, with a little to spare.
        for (int c = 0; c < 3; ++c) {
            const double allowed = std::max(least[c], 0.0) * tolerance * kBoundSlack;
            if (error[c] > allowed)
                threshold[c] *= static_cast<float>(std::clamp(0.7 * allowed / error[c], 0.02, 0.7));
        }
    }
}

void DiffusionSum::evaluate(std::span<const Vec3> receivers, double tolerance, std::span<Rgb> out,
                            Scratch& scratch, SumCounts& counts) const {
    counts.receivers += receivers.size();
    std::fill(out.begin(), out.end(), Rgb(0));
    if (nodes_.empty() || receivers.empty()) return;
    const Group group = groupAround(receivers);
    const std::vector<std::size_t> ends =
        clusterReceivers(receivers, kReceiversPerCluster, scratch.order);
    scratch.clustered.clear();
    for (const std::uint32_t i : scratch.order) scratch.clustered.push_back(receivers[i]);

    Shared shared{{}, DRgb(0), Rgb(0)};
    if (tolerance > 0)
        shared.threshold =
            Rgb(estimate(group, scratch, counts) *
                (tolerance * kBoundSlack / kFirstShares * std::pow(tolerance / 0.01, 0.25)));
    constexpr std::uint32_t kRoot = 0;
    scratch.pending.clear();
    scratch.shared.assign(receivers.size(), DRgb(0));
    const std::span<const Vec3> clustered(scratch.clustered);
    if (ends.size() == 1) {
        scratch.pending.push_back(kRoot);
    } else {
        shared.error = gather(group, shared.threshold, std::span(&kRoot, 1), &scratch.pending,
                              scratch, counts);
        addLists(clustered, scratch.shared, scratch, counts);
    }
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        const std::size_t count = end - begin;
        shared.sums = std::span(scratch.shared).subspan(begin, count);
        evaluateCluster(clustered.subspan(begin, count), tolerance, shared, scratch, counts);
        for (std::size_t k = 0; k < count; ++k)
            out[scratch.order[begin + k]] = Rgb(glm::max(scratch.sums[k], DRgb(0)));
        begin = end;
    }
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
