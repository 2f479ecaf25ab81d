#include "sss/integrate/preprocess.h"

#include "sss/base/error.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/integrate/irradiance.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>

namespace sss {
namespace {

class Stopwatch {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

std::vector<std::unique_ptr<BodyOptics>> makeBodyOptics(const World& world) {
    std::vector<std::unique_ptr<BodyOptics>> optics;
    for (const Body& body : world.bodies())
        optics.push_back(std::make_unique<BodyOptics>(world.materialOf(body)));
    return optics;
}

double pointSpacingMm(const World& world, const Body& body, const BodyOptics& optics) {
    const QualitySettings& quality = world.scene().quality;
    if (quality.spacingMm > 0) return quality.spacingMm;
    const double spacing = spacingFor(optics, quality.tolerance).spacingMm;
    return std::isfinite(spacing) ? spacing : body.mesh.bounds().diagonal();
}

BodyCloud preprocessBody(const World& world, int bodyIndex,
                         std::span<const std::unique_ptr<BodyOptics>> optics,
                         const PreprocessLimits& limits, Reporter& reporter, BodyReport& report) {
    const Body& body = world.bodies()[static_cast<std::size_t>(bodyIndex)];
    const BodyOptics& own = *optics[static_cast<std::size_t>(bodyIndex)];
    const QualitySettings& quality = world.scene().quality;
    SamplerOptions options;
    options.spacingMm = pointSpacingMm(world, body, own);
    options.seed = quality.seed;
    report.name = body.name;
    report.areaMm2 = body.mesh.area();
    const std::size_t expected = expectedPointCount(report.areaMm2, options);
    if (expected > limits.mostPoints)
        throw Error(ErrorKind::Resource, body.name,
                    fmt::format("would need {} points at a spacing of {:.4g} mm; the limit is {}",
                                expected, options.spacingMm, limits.mostPoints),
                    "check the scale of the scene (metersPerUnit), raise the tolerance, set "
                    "--spacing, or raise --max-points");

    Stopwatch watch;
    SurfaceSamples samples = sampleSurface(body.mesh, options);
    report.secondsPoints = watch.lap();
    report.points = samples.size();
    report.spacingMm = std::sqrt(report.areaMm2 / static_cast<double>(samples.size()));
    report.expectedQuadratureError = expectedQuadratureError(own, report.spacingMm);
    reporter.info("points", fmt::format("{}: {} points, spacing {:.4g} mm, expected error {:.2g} %",
                                        body.name, report.points, report.spacingMm,
                                        100 * report.expectedQuadratureError));

    const PathTracer tracer(world, optics, {});
    IrradianceResult light = computeIrradiance(world, bodyIndex, samples, tracer, reporter);
    report.secondsIrradiance = watch.lap();
    report.irradianceNoise = light.pointNoise;
    report.irradianceSamples = light.samplesPerPoint;
    report.counts = light.counts;
    reporter.info("light", fmt::format("{}: {} samples a point, {} rays, noise of a point at most "
                                       "{:.2g} %", body.name, light.samplesPerPoint,
                                       light.counts.rays, 100 * light.pointNoise));

    BodyCloud cloud;
    cloud.points = std::move(samples.points);
    cloud.irradiance = std::move(light.irradiance);
    cloud.spacingMm = report.spacingMm;
    cloud.nodes = buildOctree({cloud.points, cloud.irradiance});
    report.nodes = cloud.nodes.size();
    report.secondsOctree = watch.lap();
    return cloud;
}

}  // namespace sss
