#include "sss/app/body_stats.h"

namespace sss {
namespace {

JsonValue list(const DRgb& v) {
    JsonValue array = JsonValue::array();
    for (int c = 0; c < 3; ++c) array.push(v[c]);
    return array;
}

JsonValue describe(const ShapeExitance& shape) {
    JsonValue solved = JsonValue::object();
    solved.set("sums", shape.report.layers.sums)
        .set("iterations", shape.report.solve.iterations)
        .set("startResidual", list(shape.report.solve.start))
        .set("residual", list(shape.report.solve.residual))
        .set("negative", list(shape.report.negative))
        .set("gain", shape.gain)
        .set("localInteractions", shape.report.layers.localInteractions)
        .set("nodeInteractions", shape.report.layers.nodeInteractions)
        .set("pointInteractions", shape.report.layers.pointInteractions)
        .set("profileInteractions", shape.profile.interactions())
        .set("sourceInteractions", shape.report.sources.interactions())
        .set("collisionRays", shape.collisions.rays)
        .set("singleSeconds", shape.singleSeconds)
        .set("collisionSeconds", shape.collisionSeconds)
        .set("sourceSeconds", shape.report.sourceSeconds)
        .set("solveSeconds", shape.report.solveSeconds)
        .set("leaves", list(shape.leaves))
        .set("single", list(shape.single))
        .set("unscattered", list(shape.unscattered))
        .set("absorbed", list(shape.absorbed));
    return solved;
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
    if (report.shape) body.set("shape", describe(*report.shape));
    return body;
}

}  // namespace

void recordBodies(std::span<const BodyReport> reports, std::span<const bool> made,
                  std::span<const std::unique_ptr<BodyOptics>> optics, RunStats& stats) {
    JsonValue bodies = JsonValue::array();
    std::size_t finest = 0;
    for (const char* name : {"points", "nodes", "rays", "nan"}) stats.count(name, 0);
    for (std::size_t b = 0; b < reports.size(); ++b) {
        const BodyReport& report = reports[b];
        if (made[b]) {
            stats.count("points", report.points);
            stats.count("nodes", report.nodes);
        }
        stats.count("rays", report.counts.rays);
        stats.count("nan", report.nonFinite);
        bodies.push(describe(report, *optics[b]));
        const bool isFirst = !(reports[finest].spacingMm > 0);
        if (report.spacingMm > 0 && (isFirst || report.spacingMm < reports[finest].spacingMm))
            finest = b;
    }
    if (!reports.empty() && reports[finest].spacingMm > 0) {
        stats.value("spacingMm", reports[finest].spacingMm);
        stats.value("meanFreePathMm", list(optics[finest]->material.medium.meanFreePathMm()));
    }
    stats.value("bodies", std::move(bodies));
}

}  // namespace sss
