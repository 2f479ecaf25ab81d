#include "sss/app/pass_one.h"

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
        if (report.spacingMm < made.reports[finest].spacingMm) finest = b;
    }
    if (!made.reports.empty()) {
        stats.value("spacingMm", made.reports[finest].spacingMm);
        stats.value("meanFreePathMm", list(optics[finest]->material.medium.meanFreePathMm()));
    }
    stats.value("bodies", std::move(bodies));
}

}  // namespace

PassOne runPassOne(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                   const PreprocessLimits& limits, Reporter& reporter, RunStats& stats) {
    PassOne made;
    made.reports.resize(world.bodies().size());
    for (std::size_t b = 0; b < made.reports.size(); ++b) {
        const int body = static_cast<int>(b);
        BodyReport& report = made.reports[b];
        SurfaceSamples samples;
        std::vector<Rgb> irradiance;
        {
            const auto timer = stats.seconds("points");
            samples = placePoints(world, body, *optics[b], limits, reporter, report);
        }
        {
            const auto timer = stats.seconds("irradiance");
            irradiance = lightPoints(world, body, samples, optics, reporter, report);
        }
        const auto timer = stats.seconds("octree");
        made.clouds.push_back(buildCloud(std::move(samples), std::move(irradiance), report));
    }
    record(made, optics, stats);
    return made;
}

}  // namespace sss
