#include "sss/integrate/shape_exitance.h"

#include "sss/base/parallel.h"
#include "sss/base/stopwatch.h"
#include "sss/integrate/body_field.h"
#include "sss/integrate/returning_light.h"
#include "sss/medium/single_scatter.h"

#include <algorithm>

namespace sss {
namespace {

constexpr std::size_t kReceiversPerSum = 512;
// Points farther apart than this many mean free paths see neither their sources nor each other as
// the integrals would. (By default they are at most 1.5 apart.)
constexpr double kMostSpacingPerMfp = 4.0;
// A solution that gives out more than this beyond what scattered is none.
constexpr double kMostGain = 0.02;
// What the body sends to itself need not be known better than this times the tolerance: it is a
// tenth of its light.
constexpr double kFirstTolerance = 5;

// What the profile gives at the points themselves.
std::vector<Rgb> profileExitance(const BodyField& field, const BodyCloud::View& cloud,
                                 double tolerance, SumCounts& counts) {
    std::vector<Vec3> places;
    places.reserve(cloud.cloud.points.size());
    for (const SurfacePoint& p : cloud.cloud.points) places.push_back(p.position);
    std::vector<Rgb> exitance(places.size());
    std::vector<SumCounts> parts((places.size() + kReceiversPerSum - 1) / kReceiversPerSum);
    parallelFor(places.size(), kReceiversPerSum, [&](std::size_t begin, std::size_t end) {
        DiffusionSum::Scratch scratch;
        field.sum().evaluate(std::span(places).subspan(begin, end - begin), tolerance,
                             std::span(exitance).subspan(begin, end - begin), scratch,
                             parts[begin / kReceiversPerSum]);
    });
    for (const SumCounts& part : parts) counts.add(part);
    return exitance;
}

// Exitance by one scattering of diffuse light, of 1 that enters.
Rgb singleShare(const Medium& medium) {
    Rgb share(0);
    for (int c = 0; c < 3; ++c)
        share[c] =
            static_cast<float>(singleScatterAlbedo(medium.channel(c), Illumination::Diffuse));
    return share;
}

// Channels whose points are too far apart are none that scatter: no sources, nothing to solve.
std::array<bool, 3> leaveOutCoarse(double spacingMm, DiffusionConstants& medium) {
    std::array<bool, 3> isTooCoarse{};
    for (int c = 0; c < 3; ++c) {
        if (!medium.scatters[c] || spacingMm * medium.extinction[c] <= kMostSpacingPerMfp) continue;
        isTooCoarse[static_cast<std::size_t>(c)] = true;
        medium.scatters[c] = false;
    }
    return isTooCoarse;
}

// What becomes of the light that entered, if `all` of it leaves that has scattered and `single` of
// that but once, and whether a channel's solution is sound.
void shareOut(const BeamSources& light, const DRgb& all, const DRgb& single, double tolerance,
              ShapeExitance& result) {
    for (int c = 0; c < 3; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        const double entered = light.entered[c];
        if (!(entered > 0)) continue;
        result.unscattered[c] = light.unscattered[c] / entered;
        if (result.isTooCoarse[channel]) continue;
        const double gain = (all[c] - light.scattered[c]) / entered;
        result.gain = std::max(result.gain, gain);
        // NaN is unsound too.
        result.isUnsound[channel] =
            !(gain <= kMostGain && result.report.solve.residual[c] <= tolerance);
        if (result.isUnsound[channel]) continue;
        result.leaves[c] = (all[c] - single[c]) / entered;
        result.single[c] = single[c] / entered;
        result.absorbed[c] = 1 - (all[c] + light.unscattered[c]) / entered;
    }
}

}  // namespace

ShapeExitance solveShape(const World& world, int bodyIndex, const BodyOptics& optics,
                         const BodyCloud::View& cloud, const EnteredBeams& beams,
                         std::span<const Rgb> onceOfPassOne, Reporter& reporter) {
    const Body& body = world.bodies()[static_cast<std::size_t>(bodyIndex)];
    const double tolerance = world.scene().quality.tolerance;
    DiffusionConstants medium =
        diffusionConstants(optics.material.medium, momentsFor(optics.material));
    cloud.cloud.needAll();
    ShapeExitance result;
    std::vector<Rgb> once(onceOfPassOne.begin(), onceOfPassOne.end());
    result.isTooCoarse = leaveOutCoarse(cloud.spacingMm, medium);
    const BodyField field(body, optics, cloud, tolerance);
    const std::vector<Rgb> flat = profileExitance(field, cloud, tolerance, result.profile);
    BeamSources light = placeBeamSources(world, bodyIndex, cloud, beams, medium);
    const Stopwatch watch;
    const std::vector<Rgb> collided =
        collisionProbabilities(world, bodyIndex, cloud.cloud.points, medium, result.collisions);
    result.collisionSeconds = watch.seconds();
    const ShapeSolver solver(cloud.cloud, cloud.nodes, medium, cloud.spacingMm,
                             body.mesh.bounds().diagonal() * 1.01, tolerance, collided);
    std::vector<DRgb> fluence(flat.size());
    for (std::size_t i = 0; i < flat.size(); ++i) fluence[i] = DRgb(flat[i]) * medium.impedance;

    const DRgb scale = transferScale(medium, optics.material.medium);
    // If all of it left as along lines of sight that end within, and what leaves.
    const auto thickExitanceAt = [&](std::size_t i, int c) {
        return medium.scatters[c] ? scale[c] * fluence[i][c] / medium.impedance[c] : 0.0;
    };
    const auto exitanceAt = [&](std::size_t i, int c) {
        return double{collided[i][c]} * thickExitanceAt(i, c);
    };
    const ReturningLight back(world, bodyIndex, optics, cloud);
    const int solutions = back.isNone() ? 1 : 2;
    Progress progress(reporter, "shape",
                      static_cast<std::uint64_t>(
                          solutions * (ShapeSolver::kSourceSums + ShapeSolver::kLayerSums)));
    const auto onSum = [&] { progress.advance(); };
    result.report =
        solver.solve(light.sources, fluence, back.isNone() ? 1.0 : kFirstTolerance, onSum);
    if (!back.isNone()) {
        // Once more, now that it is known what the body sends to itself.
        std::vector<Rgb> exitance = flat;
        for (std::size_t i = 0; i < flat.size(); ++i)
            for (int c = 0; c < 3; ++c)
                if (medium.scatters[c]) exitance[i][c] = static_cast<float>(exitanceAt(i, c));
        const std::vector<Rgb> irradiance = back.irradiance(exitance);
        BodyCloud::View lit = cloud;
        lit.cloud.irradiance = irradiance;
        // What single scattering shows of it.
        const Rgb share = singleShare(optics.material.medium);
        for (std::size_t i = 0; i < once.size(); ++i)
            once[i] += share * (irradiance[i] - cloud.cloud.irradiance[i]);
        light = placeBeamSources(world, bodyIndex, lit, back.beams(beams, irradiance), medium);
        const ShapeReport first = result.report;
        result.report = solver.solve(light.sources, fluence, 1, onSum);
        result.report.add(first);
    }
    result.report.layers.add(solver.fillCounts());
    DRgb all{0}, single{0};
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const double area = cloud.cloud.points[i].areaMm2;
        for (int c = 0; c < 3; ++c) all[c] += exitanceAt(i, c) * area;
        if (!once.empty()) single += DRgb(once[i]) * area;
    }
    shareOut(light, all, single, tolerance, result);
    result.solved.resize(flat.size());
    for (std::size_t i = 0; i < flat.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            SolvedExitance& solved = result.solved[i];
            const auto channel = static_cast<std::size_t>(c);
            solved.collided[c] = collided[i][c];
            solved.thickExitance[c] = flat[i][c] / collided[i][c];
            if (result.isTooCoarse[channel] || result.isUnsound[channel]) continue;
            const double scatteredOnce = once.empty() ? 0.0 : double{once[i][c]};
            solved.correction[c] =
                static_cast<float>(exitanceAt(i, c) - scatteredOnce - double{flat[i][c]});
            solved.thickExitance[c] = static_cast<float>(thickExitanceAt(i, c));
        }
    return result;
}

}  // namespace sss
