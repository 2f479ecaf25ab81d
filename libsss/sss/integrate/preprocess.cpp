#include "sss/integrate/preprocess.h"

#include "sss/base/error.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/integrate/integrator_table.h"
#include "sss/integrate/irradiance.h"
#include "sss/integrate/single_exitance.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

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
    const double spacing = spacingFor(optics, quality.tolerance).spacingMm;
    return std::isfinite(spacing) ? spacing : body.mesh.bounds().diagonal();
}

std::size_t expectedPoints(const World& world, const Body& body, const BodyOptics& optics) {
    SamplerOptions options;
    options.spacingMm = pointSpacingMm(world, body, optics);
    return expectedPointCount(body.mesh.area(), options);
}

SurfaceSamples placePoints(const World& world, int bodyIndex, const BodyOptics& optics,
                           const PreprocessLimits& limits, Reporter& reporter, BodyReport& report) {
    const Body& body = world.bodies()[static_cast<std::size_t>(bodyIndex)];
    SamplerOptions options;
    options.spacingMm = pointSpacingMm(world, body, optics);
    options.seed = world.scene().quality.seed;
    report.name = body.name;
    report.areaMm2 = body.mesh.area();
    const std::size_t expected = expectedPoints(world, body, optics);
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
    SurfaceSamples samples = sampleSurface(body.mesh, options);
    report.points = samples.size();
    report.spacingMm = std::sqrt(report.areaMm2 / static_cast<double>(samples.size()));
    report.expectedQuadratureError = expectedQuadratureError(optics, report.spacingMm);
    reporter.info("points", fmt::format("{}: {} points, spacing {:.4g} mm, expected error {:.2g} %",
                                        body.name, report.points, report.spacingMm,
                                        100 * report.expectedQuadratureError));
    return samples;
}

IrradianceResult lightPoints(const World& world, int body, const SurfaceSamples& samples,
                             std::span<const std::unique_ptr<BodyOptics>> optics,
                             Reporter& reporter, BodyReport& report) {
    const PathTracer tracer(world, optics, {});
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

BodyCloud buildCloud(const SurfaceSamples& samples, std::vector<Rgb> irradiance,
                     BodyReport& report) {
    BodyCloud cloud;
    cloud.points = samples.points;
    cloud.irradiance = std::move(irradiance);
    cloud.spacingMm = report.spacingMm;
    cloud.nodes = buildOctree({cloud.points, cloud.irradiance});
    report.nodes = cloud.nodes.size();
    return cloud;
}

void shapeCloud(const World& world, int body, const SurfaceSamples& samples,
                const EnteredBeams& beams, std::span<const std::unique_ptr<BodyOptics>> optics,
                BodyCloud& cloud, Reporter& reporter, BodyReport& report) {
    BodyOptics& own = *optics[static_cast<std::size_t>(body)];
    std::vector<Rgb> once;
    if (own.material.singleScattering) {
        const PathTracer tracer(world, optics, nullptr);
        once = singleExitance(world, body, samples, tracer,
                              std::max(1, report.irradianceSamples / kLightPerSingleSample),
                              report.counts);
    }
    ShapeExitance shape = solveShape(world, body, own, cloud, beams, once);
    cloud.correction = std::move(shape.correction);
    own.lookThroughIf(maxComponent(shape.unscattered), world.scene().quality.tolerance);
    const GmresReport& solve = shape.report.solve;
    const auto percent = [](const DRgb& v) {
        return fmt::format("{:.3g} {:.3g} {:.3g} %", 100 * v.x, 100 * v.y, 100 * v.z);
    };
    reporter.info("shape", fmt::format("{}: {} sums, residual {:.2g}; of the light that enters, {} "
                                       "leave by multiple scattering, {} by single, {} go straight "
                                       "through, {} are absorbed",
                                       report.name, solve.iterations, maxComponent(solve.residual),
                                       percent(shape.leaves), percent(shape.single),
                                       percent(shape.unscattered), percent(shape.absorbed)));
    if (!solve.converged)
        reporter.warn("shape",
                      fmt::format("{}: after {} sums the equations hold to {:.2g} only: "
                                  "its surface cuts itself, or lies closer to itself than "
                                  "the points' spacing; set --spacing to refine",
                                  report.name, solve.iterations, maxComponent(solve.residual)));
    report.shape = std::move(shape);
}

}  // namespace sss
