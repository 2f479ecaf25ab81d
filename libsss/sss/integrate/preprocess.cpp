#include "sss/integrate/preprocess.h"

#include "sss/base/error.h"
#include "sss/base/stopwatch.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/integrate/integrator_table.h"
#include "sss/integrate/interreflection.h"
#include "sss/integrate/irradiance.h"
#include "sss/integrate/single_exitance.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sss {
namespace {

// More light out of a body than this beyond what scattered there is worth a word.
constexpr double kGainToTell = 0.01;
// Single scattering's exitance is smoothed between points and is a small part of what leaves.
constexpr int kLightPerSingleSample = 2;

}  // namespace

std::vector<std::unique_ptr<BodyOptics>> makeBodyOptics(const World& world) {
    std::vector<std::unique_ptr<BodyOptics>> optics;
    const bool usesFields = integratorOf(world.scene()).needsFields;
    for (const Body& body : world.bodies()) {
        const TranslucentMaterial& material = world.materialOf(body);
        optics.push_back(
            std::make_unique<BodyOptics>(material, material.onShape && body.closed && usesFields));
    }
    return optics;
}

double pointSpacingMm(const World& world, const Body& body, const BodyOptics& optics) {
    const QualitySettings& quality = world.scene().quality;
    if (quality.spacingMm > 0) return quality.spacingMm;
    const double finest =
        world.scene().materials[static_cast<std::size_t>(body.material)].spacingMm;
    if (finest > 0) return finest;
    const double spacing = spacingFor(optics, quality.tolerance).spacingMm;
    return std::isfinite(spacing) ? spacing : body.mesh.bounds().diagonal();
}

std::size_t expectedPoints(const World& world, const Body& body, const BodyOptics& optics,
                           const TriangleMesh* placedOn) {
    SamplerOptions options;
    options.spacingMm = pointSpacingMm(world, body, optics);
    return expectedPointCount((placedOn != nullptr ? *placedOn : body.mesh).area(), options);
}

void describePoints(const Body& body, const BodyOptics& optics, std::size_t points,
                    BodyReport& report) {
    report.name = body.name;
    report.areaMm2 = body.mesh.area();
    report.points = points;
    report.spacingMm = std::sqrt(report.areaMm2 / static_cast<double>(points));
    report.expectedQuadratureError = expectedQuadratureError(optics, report.spacingMm);
}

SurfaceSamples placePoints(const World& world, int bodyIndex, const BodyOptics& optics,
                           const PreprocessLimits& limits, Reporter& reporter, BodyReport& report,
                           const TriangleMesh* placedOn) {
    const Body& body = world.bodies()[static_cast<std::size_t>(bodyIndex)];
    const TriangleMesh& mesh = placedOn != nullptr ? *placedOn : body.mesh;
    SamplerOptions options;
    options.spacingMm = pointSpacingMm(world, body, optics);
    options.seed = world.scene().quality.seed;
    const std::size_t expected = expectedPoints(world, body, optics, placedOn);
    if (expected > limits.mostPoints)
        throw Error(ErrorKind::Resource, body.name,
                    fmt::format("would need {} points at a spacing of {:.4g} mm; the limit is {}",
                                expected, options.spacingMm, limits.mostPoints),
                    "check the scale of the scene (metersPerUnit), raise the tolerance, set "
                    "--spacing, or raise --max-points");
    if (expected > limits.mostBytes / kBytesPerPoint)
        throw Error(ErrorKind::Resource, body.name,
                    fmt::format("would need {} points at a spacing of {:.4g} mm and {:.3g} GB of "
                                "memory for them; there are {:.3g} GB",
                                expected, options.spacingMm,
                                1e-9 * static_cast<double>(expected * kBytesPerPoint),
                                1e-9 * static_cast<double>(limits.mostBytes)),
                    "check the scale of the scene (metersPerUnit), raise the tolerance, or set "
                    "--spacing");
    SurfaceSamples samples = sampleSurface(mesh, options);
    describePoints(body, optics, samples.size(), report);
    reporter.info("points", fmt::format("{}: {} points, spacing {:.4g} mm, expected error {:.2g} %",
                                        body.name, report.points, report.spacingMm,
                                        100 * report.expectedQuadratureError));
    return samples;
}

namespace {

// As pass 1 of a body sees all bodies. What its fingerprint has not in it is black, so that not
// even a ray that meets its own surface by rounding can tell.
std::vector<std::unique_ptr<BodyOptics>> opticsInLight(
    const World& world, int body, std::span<const std::unique_ptr<BodyOptics>> optics) {
    std::vector<std::unique_ptr<BodyOptics>> seen;
    for (const auto& each : optics) seen.push_back(std::make_unique<BodyOptics>(*each));
    if (!mayComeBack(world, body)) seen[static_cast<std::size_t>(body)]->diffuseAlbedo = Rgb(0);
    return seen;
}

}  // namespace

IrradianceResult lightPoints(const World& world, int body, const SurfaceSamples& samples,
                             std::span<const std::unique_ptr<BodyOptics>> optics,
                             Reporter& reporter, BodyReport& report) {
    const auto seen = opticsInLight(world, body, optics);
    const PathTracer tracer(world, seen, {});
    const bool wantsBeams = optics[static_cast<std::size_t>(body)]->onShape;
    IrradianceResult light = computeIrradiance(world, body, samples, tracer, reporter, wantsBeams);
    report.irradianceNoise = light.pointNoise;
    report.irradianceSamples = light.samplesPerPoint;
    report.counts = light.counts;
    report.nonFinite = light.nonFinite;
    if (light.nonFinite > 0)
        reporter.warn("light", fmt::format("{}: {} light samples were not finite and were left out",
                                           report.name, light.nonFinite));
    reporter.info("light", fmt::format("{}: {} samples a point, {} rays, noise of a point at most "
                                       "{:.2g} %",
                                       report.name, light.samplesPerPoint, light.counts.rays,
                                       100 * light.pointNoise));
    return light;
}

namespace {

// How samples are sorted to be a cloud; empty if they stand so.
std::vector<std::uint32_t> cloudOrder(const SurfaceSamples& samples) {
    if (samples.inMortonOrder) return {};
    return cloudOrder(CloudView{samples.points, {}});
}

template <typename T>
std::vector<T> inOrder(std::vector<T> items, std::span<const std::uint32_t> order,
                       std::size_t perPoint = 1) {
    if (order.empty()) return items;
    std::vector<T> sorted;
    sorted.reserve(items.size());
    for (const std::uint32_t i : order)
        for (std::size_t k = 0; k < perPoint; ++k) sorted.push_back(items[i * perPoint + k]);
    return sorted;
}

}  // namespace

EnteredBeams beamsInOrder(const SurfaceSamples& samples, EnteredBeams beams) {
    return {inOrder(std::move(beams.directions), cloudOrder(samples), EnteredBeams::kPerPoint)};
}

BodyCloud buildCloud(const SurfaceSamples& samples, std::vector<Rgb> irradiance,
                     BodyReport& report) {
    const std::vector<std::uint32_t> order = cloudOrder(samples);
    BodyCloud cloud;
    cloud.points = inOrder(samples.points, order);
    irradiance = inOrder(std::move(irradiance), order);
    cloud.irradiance = std::move(irradiance);
    cloud.spacingMm = report.spacingMm;
    cloud.nodes = buildOctree({cloud.points, cloud.irradiance});
    report.nodes = cloud.nodes.size();
    return cloud;
}

namespace {

std::string namesOf(const std::array<bool, 3>& channels) {
    std::string names;
    for (std::size_t c = 0; c < 3; ++c)
        if (channels[c]) names += "RGB"[c];
    return names;
}

void describeSolution(const ShapeExitance& shape, const Medium& medium, double spacingMm,
                      const std::string& name, Reporter& reporter) {
    const GmresReport& solve = shape.report.solve;
    const double residual = maxComponent(solve.residual);
    const auto percent = [](const DRgb& v) {
        return fmt::format("{:.3g} {:.3g} {:.3g} %", 100 * v.x, 100 * v.y, 100 * v.z);
    };
    reporter.info("shape", fmt::format("{}: {} sums, residual {:.2g}; of the light that enters, {} "
                                       "leave by multiple scattering, {} by single, {} go straight "
                                       "through, {} are absorbed",
                                       name, solve.iterations, residual, percent(shape.leaves),
                                       percent(shape.single), percent(shape.unscattered),
                                       percent(shape.absorbed)));
    if (const std::string coarse = namesOf(shape.isTooCoarse); !coarse.empty())
        reporter.warn("shape",
                      fmt::format("{}: its points are {:.3g} mm apart, too far for mean "
                                  "free paths of {:.3g} mm and more: diffusion is by the "
                                  "profile in {}; set --spacing to refine",
                                  name, spacingMm, medium.smallestMeanFreePathMm(), coarse));
    const std::string unsound = namesOf(shape.isUnsound);
    if (!unsound.empty())
        reporter.warn(
            "shape",
            fmt::format("{}: what was solved on its shape does not keep the light ({:.2g} % more "
                        "leaves than scatters, residual {:.2g}): diffusion is by the profile in "
                        "{}; its surface cuts itself, or lies closer to itself than its points, "
                        "{:.3g} mm apart (mean free path {:.3g} mm); set --spacing to refine",
                        name, 100 * shape.gain, residual, unsound, spacingMm,
                        medium.smallestMeanFreePathMm()));
    else if (shape.gain > kGainToTell)
        reporter.warn("shape",
                      fmt::format("{}: {:.2g} % more light leaves than scatters in it; set "
                                  "--spacing below {:.3g} mm to refine",
                                  name, 100 * shape.gain, spacingMm));
    if (unsound.empty() && !solve.converged)
        reporter.warn("shape", fmt::format("{}: after {} sums the equations hold to {:.2g} only: "
                                           "its surface cuts itself, or lies closer to itself than "
                                           "the points' spacing; set --spacing to refine",
                                           name, solve.iterations, residual));
}

}  // namespace

std::vector<SolvedExitance> shapeSolution(const World& world, int body,
                                          const SurfaceSamples& samples, const EnteredBeams& beams,
                                          std::span<const std::unique_ptr<BodyOptics>> optics,
                                          const BodyCloud::View& cloud, Reporter& reporter,
                                          BodyReport& report) {
    BodyOptics& own = *optics[static_cast<std::size_t>(body)];
    std::vector<Rgb> once;
    const Stopwatch watch;
    if (own.material.singleScattering) {
        const PathTracer tracer(world, optics, nullptr);
        once = inOrder(singleExitance(world, body, samples, tracer,
                                      std::max(1, report.irradianceSamples / kLightPerSingleSample),
                                      report.counts),
                       cloudOrder(samples));
    }
    const double singleSeconds = watch.seconds();
    ShapeExitance shape = solveShape(world, body, own, cloud, beams, once, reporter);
    shape.singleSeconds = singleSeconds;
    std::vector<SolvedExitance> solved = std::move(shape.solved);
    report.unscatteredShare = maxComponent(shape.unscattered);
    own.lookThroughIf(report.unscatteredShare, world.scene().quality.tolerance);
    if (!own.seesThrough)
        for (SolvedExitance& point : solved) {
            point.thickExitance *= point.collided;
            point.collided = Rgb(1);
        }
    describeSolution(shape, own.material.medium, cloud.spacingMm, report.name, reporter);
    report.shape = std::move(shape);
    return solved;
}

}  // namespace sss
