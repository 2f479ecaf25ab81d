#include "sum_methods.h"

#include "receivers.h"
#include "solid_angle_tree.h"
#include "sss/base/parallel.h"

#include <cmath>

namespace sss::bench {
namespace {

// A row of the kernel table.
constexpr double kRowBytes = sizeof(KernelTable::Row);
// Kernel and weighted sum from a row: three fused steps and one with the flux, by three channels.
constexpr double kRowFlops = 2 * 4 * 3;

// Offsets and distance 9; place in the row 1, its powers 2. With moments: the products with the
// offset and the trace (scaling 5, Q d 15, d^T Q d 5, trace 3), and the weights of the row 14.
InteractionCost ourCost() {
    InteractionCost cost;
    cost.pointFlops = 9 + 1 + 2 + kRowFlops;
    cost.nodeFlops = 9 + 1 + 2 + 28 + 14 + kRowFlops;
    // Slope and bend by the table 10, by three channels; products with the offset and their sums,
    // for slope, trace and six of the curvature.
    cost.localFlops = cost.nodeFlops + 3 * (10 + 2 * (3 + 1 + 6) + 6);
    cost.tableRows = 1;
    cost.pointBytes = 4 * (3 + 4) + kRowBytes;
    cost.nodeBytes = 4 * (3 + 4 + 6) + kRowBytes;
    return cost;
}

class Ours : public SumMethod {
public:
    explicit Ours(const Hierarchy& hierarchy) : hierarchy_(hierarchy) {}
    std::string name() const override { return "ours"; }
    std::string label() const override { return "ours"; }
    std::string settingName() const override { return "tolerance"; }
    std::vector<double> settings(const std::vector<double>& tolerances) const override {
        return tolerances;
    }
    InteractionCost cost() const override { return ourCost(); }
    void evaluate(std::span<const Vec3> receivers, double setting, std::span<Rgb> out,
                  MethodCounts& counts) const override {
        DiffusionSum::Scratch scratch;
        SumCounts spent;
        for (std::size_t i = 0; i < receivers.size(); i += kGroup) {
            const std::size_t n = std::min(kGroup, receivers.size() - i);
            hierarchy_.sum.evaluate(receivers.subspan(i, n), setting, out.subspan(i, n), scratch,
                                    spent);
        }
        counts.localInteractions += spent.localInteractions;
        counts.nodeInteractions += spent.nodeInteractions;
        counts.pointInteractions += spent.pointInteractions;
        counts.nodesVisited += spent.nodesVisited;
    }

private:
    const Hierarchy& hierarchy_;
};

// The same inner loop over all points: brute force as fast as it can be.
class BruteForce final : public Ours {
public:
    using Ours::Ours;
    std::string name() const override { return "brute-force"; }
    std::string label() const override { return "brute force"; }
    std::vector<double> settings(const std::vector<double>&) const override { return {0}; }
};

template <typename Kernel>
class Classic final : public SumMethod {
public:
    Classic(const Hierarchy& hierarchy, Kernel kernel, std::string suffix)
        : tree_({hierarchy.cloud.points, hierarchy.cloud.irradiance}, hierarchy.cloud.nodes),
          kernel_(std::move(kernel)),
          suffix_(std::move(suffix)) {}
    std::string name() const override { return "solid-angle" + suffix_; }
    std::string label() const override {
        return suffix_.empty() ? "solid angle, exps" : "solid angle, our table";
    }
    std::string settingName() const override { return "solid angle"; }
    // Measured on the bench's scenes: 99.9 % of receivers are within 0.18 x solid angle^1.2. So the
    // curve covers the errors asked of ours.
    std::vector<double> settings(const std::vector<double>& tolerances) const override {
        std::vector<double> limits;
        for (const double t : tolerances) limits.push_back(3 * std::pow(t, 0.83));
        return limits;
    }
    InteractionCost cost() const override {
        InteractionCost cost;
        const bool closed = suffix_.empty();
        // Distance 9; per channel and source of the closed form 12, besides roots and exponentials.
        cost.nodeFlops = cost.pointFlops = closed ? 9 + 3 * (2 * 12 + 2) : 9 + 3 + kRowFlops;
        cost.exponentials = cost.squareRoots = closed ? 6 : 0;
        cost.tableRows = closed ? 0 : 1;
        cost.nodeBytes = 64 + (closed ? 0 : kRowBytes);
        cost.pointBytes = 24 + (closed ? 0 : kRowBytes);
        return cost;
    }
    void evaluate(std::span<const Vec3> receivers, double setting, std::span<Rgb> out,
                  MethodCounts& counts) const override {
        SolidAngleTree::Counts spent;
        const auto limit = static_cast<float>(setting);
        for (std::size_t i = 0; i < receivers.size(); ++i)
            out[i] = tree_.evaluate(kernelOf(kernel_), receivers[i], limit, spent);
        counts.nodeInteractions += spent.nodeInteractions;
        counts.pointInteractions += spent.pointInteractions;
        counts.nodesVisited += spent.nodesVisited;
    }

private:
    static const SolidAngleTree::ClosedForm& kernelOf(const SolidAngleTree::ClosedForm& k) {
        return k;
    }
    static const KernelTable& kernelOf(const KernelTable* k) { return *k; }
    SolidAngleTree tree_;
    Kernel kernel_;
    std::string suffix_;
};

}  // namespace

Hierarchy::Hierarchy(const Stage& where, BodyCloud made)
    : cloud(std::move(made)),
      table(where.optics().profilePointers(), where.body().mesh.bounds().diagonal() * 1.01,
            cloud.spacingMm / std::sqrt(kPi)),
      sum(cloud.view().cloud, cloud.nodes, table),
      stage(where) {}

std::vector<DRgb> Hierarchy::bruteForce(std::span<const Vec3> receivers) const {
    std::vector<DRgb> truth(receivers.size());
    parallelFor(receivers.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) truth[i] = sum.bruteForce(receivers[i]);
    });
    return truth;
}

std::unique_ptr<SumMethod> ourMethod(const Hierarchy& hierarchy) {
    return std::make_unique<Ours>(hierarchy);
}

std::vector<std::unique_ptr<SumMethod>> sumMethods(const Hierarchy& hierarchy) {
    const BodyOptics& optics = hierarchy.stage.optics();
    const SolidAngleTree::ClosedForm closedForm(
        optics.material.medium, optics.material.profileOptions, optics.profilePointers());
    std::vector<std::unique_ptr<SumMethod>> methods;
    methods.push_back(ourMethod(hierarchy));
    methods.push_back(
        std::make_unique<Classic<SolidAngleTree::ClosedForm>>(hierarchy, closedForm, ""));
    methods.push_back(
        std::make_unique<Classic<const KernelTable*>>(hierarchy, &hierarchy.table, "-table"));
    methods.push_back(std::make_unique<BruteForce>(hierarchy));
    return methods;
}

}  // namespace sss::bench
