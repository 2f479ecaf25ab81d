#include "sss/shape/shape_solver.h"

#include "sss/base/parallel.h"
#include "sss/base/stopwatch.h"
#include "sss/shape/disk_mean.h"
#include "sss/shape/screened_green.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sss {
namespace {

// A point at a sharp edge or between sheets closer than the spacing may see anything; this keeps
// its equation well posed.
constexpr float kLeastFill = 0.05f, kMostFill = 1.0f;
// Of the tolerance. Measured on half-lit balls of marble and ketchup, 12 mean free paths wide
// (shape_solver_test), against a far finer solution: all together add 0.2 to 0.5 of it, RMS.
constexpr double kLayerShare = 0.5, kFillShare = 0.25, kSourceShare = 1.0, kResidualShare = 0.2;
constexpr int kMostIterations = 60;
// A product's error beyond this share of its own size no longer helps the next.
constexpr double kCrudest = 0.1;
// Enough for the sums to take far sources by groups of receivers, few enough for threads to share.
constexpr std::size_t kReceiversPerSum = 512;
// In radii of a cell: a source farther from it is for it as for its point.
constexpr double kFarFromCell = 3.0;
// Below this part of the brightest fluence nobody asks for relative accuracy.
constexpr double kDarkest = 1e-6;

KernelTable greenTable(const DRgb& screening, double reachMm, double cellRadiusMm) {
    const ScreenedGreen r(screening.x, reachMm), g(screening.y, reachMm), b(screening.z, reachMm);
    return {{&r, &g, &b}, reachMm, cellRadiusMm};
}

}  // namespace

void ShapeReport::add(const ShapeReport& earlier) {
    solve.iterations += earlier.solve.iterations;
    layers.add(earlier.layers);
    sources.add(earlier.sources);
    sourceSeconds += earlier.sourceSeconds;
    solveSeconds += earlier.solveSeconds;
}

ShapeSolver::ShapeSolver(const CloudView& cloud, std::span<const OctreeNode> nodes,
                         const DiffusionConstants& medium, double spacingMm, double reachMm,
                         double tolerance, std::span<const Rgb> collided)
    : cloud_(cloud),
      nodes_(nodes),
      medium_(medium),
      spacingMm_(spacingMm),
      reachMm_(reachMm),
      tolerance_(tolerance),
      collided_(collided) {
    measureFill();
}

void ShapeSolver::measureFill() {
    const KernelTable table = greenTable(DRgb(0), reachMm_, spacingMm_ / std::sqrt(kPi));
    ChargeTree tree(cloud_, nodes_);
    const std::vector<DRgb> one(cloud_.size(), DRgb(1));
    tree.setFluence(one, std::vector<DRgb>(cloud_.size(), DRgb(0)));
    std::vector<DRgb> angle(cloud_.size());
    const std::vector<Rgb> allowed(cloud_.size(), Rgb(static_cast<float>(kFillShare * tolerance_)));
    LayerSum(tree, table, DRgb(0)).atPoints(allowed, angle, fillCounts_);
    fill_.reserve(cloud_.size());
    for (const DRgb& a : angle)
        fill_.push_back(std::clamp(static_cast<float>(-a.x), kLeastFill, kMostFill));
}

// What the sources alone would make, in an endless medium.
std::vector<DRgb> ShapeSolver::direct(std::span<const VolumeSource> sources, double tolerance,
                                      SumCounts& counts) const {
    const std::size_t n = cloud_.size();
    const KernelTable near = greenTable(medium_.screening, reachMm_, spacingMm_ / std::sqrt(kPi));
    std::vector<Vec3> places;
    for (const SurfacePoint& p : cloud_.points) places.push_back(p.position);
    std::vector<DRgb> fluence(n, DRgb(0));
    for (const SourceCloud& kind : SourceCloud::byKind(sources)) {
        const DiffusionSum sum(kind.view(), kind.nodes(), near);
        std::vector<Rgb> values(n);
        std::vector<SumCounts> parts((n + kReceiversPerSum - 1) / kReceiversPerSum);
        parallelFor(n, kReceiversPerSum, [&](std::size_t begin, std::size_t end) {
            DiffusionSum::Scratch scratch;
            sum.evaluate(std::span(places).subspan(begin, end - begin), kSourceShare * tolerance,
                         std::span(values).subspan(begin, end - begin), scratch,
                         parts[begin / kReceiversPerSum]);
        });
        for (const SumCounts& part : parts) counts.add(part);
        for (std::size_t i = 0; i < n; ++i) fluence[i] += DRgb(values[i]) / medium_.diffusionMm;
    }
    correctOwnCells(sources, near, fluence);
    return fluence;
}

// A source less than a spacing below its point gives it more than the mean of its cell, and every
// point of a lit place has one: all light would be up to a tenth too much, and uneven from point to
// point. For the cells beside, the table is right.
void ShapeSolver::correctOwnCells(std::span<const VolumeSource> sources, const KernelTable& near,
                                  std::span<DRgb> fluence) const {
    std::vector<DRgb> more(sources.size(), DRgb(0));
    parallelFor(sources.size(), kReceiversPerSum, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const VolumeSource& source = sources[s];
            if (source.from == VolumeSource::kNowhere) continue;
            const SurfacePoint& point = cloud_.points[source.from];
            const Vec3 away = source.position - point.position;
            const float squared = glm::dot(away, away);
            const double radius = std::sqrt(double{point.areaMm2} / kPi);
            if (!(double{squared} < std::pow(kFarFromCell * radius, 2))) continue;
            const double depth = std::abs(double{glm::dot(away, decodeUnitVector(point.normal))});
            const double aside = std::sqrt(std::max(0.0, double{squared} - depth * depth));
            const DRgb missing = diskMeanOfGreen(medium_.screening, radius, aside, depth) -
                                 DRgb(near.evaluate(squared));
            for (int c = 0; c < 3; ++c)
                if (medium_.scatters[c])
                    more[s][c] = double{source.power[c]} * missing[c] / medium_.diffusionMm[c];
        }
    });
    for (std::size_t s = 0; s < sources.size(); ++s)
        if (sources[s].from != VolumeSource::kNowhere) fluence[sources[s].from] += more[s];
}

ShapeReport ShapeSolver::solve(std::span<const VolumeSource> sources, std::span<DRgb> fluence,
                               double coarser, const std::function<void()>& onSum) const {
    Stopwatch watch;
    ShapeReport report;
    const double tolerance = tolerance_ * coarser;
    const std::size_t n = cloud_.size();
    const KernelTable table = greenTable(medium_.screening, reachMm_, spacingMm_ / std::sqrt(kPi));
    std::vector<DRgb> right = direct(sources, tolerance, report.sources);
    report.sourceSeconds = watch.seconds();
    watch.restart();
    for (int k = 0; k < kSourceSums && onSum; ++k) onSum();
    // Unknowns and equations in units of the local fluence.
    DRgb most{0};
    for (const DRgb& v : fluence) most = glm::max(most, v);
    std::vector<DRgb> scale(n);
    for (std::size_t i = 0; i < n; ++i) {
        // On a flat place the sources' field is half of the fluence and more.
        const DRgb likely = glm::min(fluence[i], 2.0 * right[i]);
        scale[i] = glm::max(glm::max(likely, kDarkest * most), DRgb(1e-30));
        right[i] /= scale[i];
        fluence[i] /= scale[i];
    }
    const DRgb perLength = 1.0 / medium_.boundaryMm;
    std::vector<DRgb> perLengthHere(n, perLength);
    for (std::size_t i = 0; i < collided_.size(); ++i) perLengthHere[i] *= DRgb(collided_[i]);
    ChargeTree tree(cloud_, nodes_);
    const LayerSum layers(tree, table, perLength);
    std::vector<DRgb> own(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double area = cloud_.points[i].areaMm2, radius = std::sqrt(area / kPi);
        own[i] = (0.5 * radius - area * DRgb(table.evaluate(0.0f))) * perLengthHere[i];
    }
    std::vector<Rgb> allowed(n);
    std::vector<DRgb> absolute(n);
    const auto apply = [&](std::span<const DRgb> in, const DRgb& weight, std::span<DRgb> out) {
        DRgb squares{0};
        for (std::size_t i = 0; i < n; ++i) {
            absolute[i] = in[i] * scale[i];
            squares += in[i] * in[i];
        }
        const DRgb size = glm::sqrt(squares / static_cast<double>(n));
        const DRgb care = glm::min(tolerance * kLayerShare / glm::max(weight, DRgb(1e-6)),
                                   DRgb(std::max(kCrudest, tolerance * kLayerShare)));
        for (std::size_t i = 0; i < n; ++i) allowed[i] = Rgb(size * scale[i] * care);
        tree.setFluence(absolute, perLengthHere);
        layers.atPoints(allowed, out, report.layers);
        if (onSum) onSum();
        for (std::size_t i = 0; i < n; ++i)
            out[i] = out[i] / scale[i] + (static_cast<double>(fill_[i]) + own[i]) * in[i];
    };
    report.solve = gmres(apply, right, fluence, kResidualShare * tolerance, kMostIterations);
    DRgb below{0}, total{0};
    for (std::size_t i = 0; i < n; ++i) {
        fluence[i] *= scale[i];
        const double area = cloud_.points[i].areaMm2;
        below += area * glm::max(-fluence[i], DRgb(0));
        total += area * glm::abs(fluence[i]);
        fluence[i] = glm::max(fluence[i], DRgb(0));
    }
    report.solveSeconds = watch.seconds();
    report.negative = below / glm::max(total, DRgb(std::numeric_limits<double>::min()));
    return report;
}

}  // namespace sss
