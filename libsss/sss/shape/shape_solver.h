#pragma once
#include "sss/cloud/diffusion_sum.h"
#include "sss/shape/charge_tree.h"
#include "sss/shape/diffusion_constants.h"
#include "sss/shape/gmres.h"
#include "sss/shape/layer_sum.h"
#include "sss/shape/source_cloud.h"

#include <functional>
#include <span>
#include <vector>

namespace sss {

struct ShapeReport {
    GmresReport solve;
    /// Share of the fluence that came out below 0, which no fluence is: it was set to 0.
    DRgb negative{0};
    LayerCounts layers;
    SumCounts sources;
    double sourceSeconds = 0, solveSeconds = 0;  ///< of the clock on the wall

    /// What was spent on an earlier solution, from which this one went on.
    void add(const ShapeReport& earlier);
};

/// The diffusion equation on a body's own shape, by boundary elements over its point cloud: one
/// unknown, the fluence, at every point (README.md of this folder derives it).
///
///   phi/2 + integral over the boundary of [G p / b + dG/dn] phi = phi_source
///
/// where p is 1, or less where the body is thin (collision_probability.h): phi leaves as
/// M = p phi / (2 A),
/// with Gauss' identity, integral of dG0/dn = -1/2, in place of the 1/2: the strong part of dG/dn
/// cancels for whatever angle the surface makes at a point.
class ShapeSolver {
public:
    /// `cloud` (points, octree) of one closed body must outlive the solver; `spacingMm` is theirs,
    /// `reachMm` the largest distance within the body. `tolerance`: relative to the local fluence.
    /// `collided`: p by point, in (0, 1], which must outlive the solver; none if all are 1.
    ShapeSolver(const CloudView& cloud, std::span<const OctreeNode> nodes,
                const DiffusionConstants& medium, double spacingMm, double reachMm,
                double tolerance, std::span<const Rgb> collided = {});

    /// Fluence at the points, W m^-2, from the guess that it holds: the right order of magnitude
    /// everywhere sets what may be missed where, and it is where the iteration starts. `coarser`:
    /// times the tolerance. `onSum`, if any, is called after every sum, kSourceSums times
    /// after that of the sources.
    ShapeReport solve(std::span<const VolumeSource> sources, std::span<DRgb> fluence,
                      double coarser = 1, const std::function<void()>& onSum = {}) const;
    /// What the sources' sum takes, about, in sums over the layers, and how many of those are made.
    static constexpr int kSourceSums = 4, kLayerSums = 5;
    /// Solid angle over 4 pi that the body fills as seen from each point: 1/2 where it is flat.
    std::span<const float> fill() const { return fill_; }
    /// What was spent on that.
    const LayerCounts& fillCounts() const { return fillCounts_; }

private:
    void measureFill();
    std::vector<DRgb> direct(std::span<const VolumeSource> sources, double tolerance,
                             SumCounts& counts) const;
    void correctOwnCells(std::span<const VolumeSource> sources, const KernelTable& near,
                         std::span<DRgb> fluence) const;

    CloudView cloud_;
    std::span<const OctreeNode> nodes_;
    DiffusionConstants medium_;
    double spacingMm_, reachMm_, tolerance_;
    std::span<const Rgb> collided_;
    std::vector<float> fill_;
    LayerCounts fillCounts_;
};

}  // namespace sss
