#pragma once
#include "sss/cloud/diffusion_sum.h"
#include "stage.h"

#include <memory>
#include <string>
#include <vector>

namespace sss::bench {

/// What a sum over one cloud cost, whatever the method.
struct MethodCounts {
    std::uint64_t localInteractions = 0, nodeInteractions = 0, pointInteractions = 0;
    std::uint64_t nodesVisited = 0;
    std::uint64_t interactions() const {
        return localInteractions + nodeInteractions + pointInteractions;
    }
};

/// What one interaction of a method does, by its formula. Multiply and add count one each, a fused
/// multiply-add two; a channel that only pads a vector is not counted.
struct InteractionCost {
    double localFlops = 0, nodeFlops = 0, pointFlops = 0;
    double exponentials = 0, squareRoots = 0, tableRows = 0;
    double nodeBytes = 0, pointBytes = 0;  ///< of the source and its table row, at full precision
};

/// One way to sum the same kernel over the same points: a curve of error over time, with one number
/// to set.
class SumMethod {
public:
    virtual ~SumMethod() = default;
    virtual std::string name() const = 0;
    virtual std::string label() const = 0;        ///< for plots
    virtual std::string settingName() const = 0;  ///< "tolerance", "solid angle"
    virtual std::vector<double> settings(const std::vector<double>& tolerances) const = 0;
    virtual InteractionCost cost() const = 0;
    /// Groups of kGroup receivers, one after the other, on the calling thread.
    virtual void evaluate(std::span<const Vec3> receivers, double setting, std::span<Rgb> out,
                          MethodCounts& counts) const = 0;
};

/// A cloud with everything that its sums need.
struct Hierarchy {
    Hierarchy(const Stage& stage, BodyCloud made);
    Hierarchy(const Hierarchy&) = delete;
    Hierarchy& operator=(const Hierarchy&) = delete;

    BodyCloud cloud;
    KernelTable table;
    DiffusionSum sum;
    const Stage& stage;

    std::vector<DRgb> bruteForce(std::span<const Vec3> receivers) const;
};

/// Ours, the classic traversal with the closed form and with our table, brute force. They keep a
/// reference to `hierarchy`.
std::vector<std::unique_ptr<SumMethod>> sumMethods(const Hierarchy& hierarchy);
/// Ours alone.
std::unique_ptr<SumMethod> ourMethod(const Hierarchy& hierarchy);

}  // namespace sss::bench
