#include "sss/app/pass_one.h"

#include <fmt/core.h>

namespace sss {
namespace {

JsonValue list(const DRgb& v) {
    JsonValue array = JsonValue::array();
    for (int c = 0; c < 3; ++c) array.push(v[c]);
    return array;
}

JsonValue describe(const BodyReport& report, const BodyOptics& optics) {
    JsonValue body = JsonValue::object();
    body.set("name", report.name)
        .set("points", report.points)
        .set("nodes", report.nodes)
        .set("areaMm2", report.areaMm2)
        .set("spacingMm", report.spacingMm)
        .set("meanFreePathMm", list(optics.material.medium.meanFreePathMm()))
        .set("expectedQuadratureError", report.expectedQuadratureError)
        .set("irradianceSamples", report.irradianceSamples)
        .set("irradianceNoise", report.irradianceNoise);
    if (report.shape) {
        const ShapeExitance& shape = *report.shape;
        JsonValue solved = JsonValue::object();
        solved.set("sums", shape.report.layers.sums)
            .set("iterations", shape.report.solve.iterations)
            .set("residual", list(shape.report.solve.residual))
            .set("nodeInteractions", shape.report.layers.nodeInteractions)
            .set("pointInteractions", shape.report.layers.pointInteractions)
            .set("sourceInteractions", shape.report.sources.interactions())
            .set("leaves", list(shape.leaves))
            .set("single", list(shape.single))
            .set("unscattered", list(shape.unscattered))
            .set("absorbed", list(shape.absorbed));
        body.set("shape", std::move(solved));
    }
    return body;
}

void record(const PassOne& made, std::span<const std::unique_ptr<BodyOptics>> optics,
            RunStats& stats) {
    JsonValue bodies = JsonValue::array();
    std::size_t finest = 0;
    for (const char* name : {"points", "nodes", "rays", "nan"}) stats.count(name, 0);
    for (std::size_t b = 0; b < made.reports.size(); ++b) {
        const BodyReport& report = made.reports[b];
        stats.count("points", report.points);
        stats.count("nodes", report.nodes);
        stats.count("rays", report.counts.rays);
        stats.count("nan", report.nonFinite);
        bodies.push(describe(report, *optics[b]));
        const bool isFirst = !(made.reports[finest].spacingMm > 0);
        if (report.spacingMm > 0 && (isFirst || report.spacingMm < made.reports[finest].spacingMm))
            finest = b;
    }
    if (!made.reports.empty() && made.reports[finest].spacingMm > 0) {
        stats.value("spacingMm", made.reports[finest].spacingMm);
        stats.value("meanFreePathMm", list(optics[finest]->material.medium.meanFreePathMm()));
    }
    stats.value("bodies", std::move(bodies));
}

// Far more points than a body can want, had it not been for its limit.
void warnOfScale(const World& world, std::size_t body, const BodyOptics& optics,
                 const PreprocessLimits& limits, Reporter& reporter) {
    const Body& which = world.bodies()[body];
    const std::size_t expected = expectedPoints(world, which, optics);
    if (expected > limits.mostPoints)
        reporter.warn("points", fmt::format("{}: would need {} points, were it not in its diffuse "
                                            "limit: check the scale of the scene (metersPerUnit)",
                                            which.name, expected));
}

}  // namespace

PassOne runPassOne(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                   const PreprocessLimits& limits, Reporter& reporter, RunStats& stats) {
    PassOne made;
    made.reports.resize(world.bodies().size());
    for (std::size_t b = 0; b < made.reports.size(); ++b) {
        const int body = static_cast<int>(b);
        BodyReport& report = made.reports[b];
        if (optics[b]->inDiffuseLimit) {
            warnOfScale(world, b, *optics[b], limits, reporter);
            report.name = world.bodies()[b].name;
            report.areaMm2 = world.bodies()[b].mesh.area();
            made.clouds.emplace_back();
            continue;
        }
        SurfaceSamples samples;
        IrradianceResult light;
        {
            const auto timer = stats.seconds("points");
            samples = placePoints(world, body, *optics[b], limits, reporter, report);
        }
        {
            const auto timer = stats.seconds("irradiance");
            light = lightPoints(world, body, samples, optics, reporter, report);
        }
        {
            const auto timer = stats.seconds("octree");
            made.clouds.push_back(buildCloud(samples, std::move(light.irradiance), report));
        }
        if (optics[b]->onShape) {
            const auto timer = stats.seconds("shape");
            shapeCloud(world, body, samples, light.beams, optics, made.clouds.back(), reporter,
                       report);
        }
    }
    record(made, optics, stats);
    return made;
}

}  // namespace sss
