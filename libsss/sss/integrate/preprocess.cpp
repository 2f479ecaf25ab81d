#include "sss/integrate/preprocess.h"

#include "sss/base/error.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/integrate/irradiance.h"

#include <fmt/core.h>

#include <cmath>

namespace sss {
std::vector<std::unique_ptr<BodyOptics>> makeBodyOptics(const World& world) {
    std::vector<std::unique_ptr<BodyOptics>> optics;
    for (const Body& body : world.bodies())
        optics.push_back(std::make_unique<BodyOptics>(world.materialOf(body)));
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
    const std::size_t expected = expectedPointCount(mesh.area(), options);
    if (expected > limits.mostPoints)
        throw Error(ErrorKind::Resource, body.name,
                    fmt::format("would need {} points at a spacing of {:.4g} mm; the limit is {}",
                                expected, options.spacingMm, limits.mostPoints),
                    "check the scale of the scene (metersPerUnit), raise the tolerance, set "
                    "--spacing, or raise --max-points");
    SurfaceSamples samples = sampleSurface(mesh, options);
    describePoints(body, optics, samples.size(), report);
    reporter.info("points", fmt::format("{}: {} points, spacing {:.4g} mm, expected error {:.2g} %",
                                        body.name, report.points, report.spacingMm,
                                        100 * report.expectedQuadratureError));
    return samples;
}

std::vector<Rgb> lightPoints(const World& world, int body, const SurfaceSamples& samples,
                             std::span<const std::unique_ptr<BodyOptics>> optics,
                             Reporter& reporter, BodyReport& report) {
    const PathTracer tracer(world, optics, {});
    IrradianceResult light = computeIrradiance(world, body, samples, tracer, reporter);
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
    return std::move(light.irradiance);
}

namespace {

template <typename T>
std::vector<T> inOrder(const std::vector<T>& items, std::span<const std::uint32_t> order) {
    std::vector<T> sorted;
    sorted.reserve(items.size());
    for (const std::uint32_t i : order) sorted.push_back(items[i]);
    return sorted;
}

}  // namespace

BodyCloud buildCloud(SurfaceSamples samples, std::vector<Rgb> irradiance, BodyReport& report) {
    BodyCloud cloud;
    if (!samples.inMortonOrder) {
        std::vector<Vec3> positions;
        for (const SurfacePoint& point : samples.points) positions.push_back(point.position);
        const std::vector<std::uint32_t> order = mortonOrder(positions);
        samples.points = inOrder(samples.points, order);
        irradiance = inOrder(irradiance, order);
    }
    cloud.points = std::move(samples.points);
    cloud.irradiance = std::move(irradiance);
    cloud.spacingMm = report.spacingMm;
    cloud.nodes = buildOctree({cloud.points, cloud.irradiance});
    report.nodes = cloud.nodes.size();
    return cloud;
}

}  // namespace sss
