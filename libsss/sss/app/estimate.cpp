#include "sss/app/estimate.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sss {
namespace {

constexpr double kTrialPoints = 2000;
// Placing a point, of one thread; on top of what the trial says.
constexpr double kSecondsPerPoint = 10e-6;

double nowSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

JsonValue estimatePassOne(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics) {
    SilentReporter silent;
    const auto light = world.inLightSpace();
    double points = 0, seconds = 0;
    JsonValue bodies = JsonValue::array();
    for (std::size_t b = 0; b < optics.size(); ++b) {
        const Body& body = world.bodies()[b];
        SamplerOptions sampling;
        sampling.spacingMm = pointSpacingMm(world, body, *optics[b]);
        const double area = body.mesh.area();
        const auto wanted = static_cast<double>(expectedPointCount(area, sampling));
        JsonValue entry = JsonValue::object();
        entry.set("name", body.name).set("points", wanted).set("spacingMm", sampling.spacingMm);
        bodies.push(std::move(entry));
        points += wanted;

        const double wantedMm = sampling.spacingMm;
        sampling.spacingMm = std::max(wantedMm, std::sqrt(area / kTrialPoints));
        const double start = nowSeconds();
        const SurfaceSamples trial = sampleSurface(body.mesh, sampling);
        const double placed = nowSeconds();
        BodyReport report;
        describePoints(body, *optics[b], trial.size(), report);
        IrradianceResult lit =
            lightPoints(*light, static_cast<int>(b), trial, optics, silent, report);
        if (optics[b]->onShape) {
            BodyCloud cloud = buildCloud(trial, std::move(lit.irradiance), report);
            cloud.spacingMm = wantedMm;  // too far apart, nothing would be solved
            shapeCorrection(*light, static_cast<int>(b), trial, lit.beams, optics, cloud.view(),
                            silent, report);
        }
        const double done = nowSeconds();
        const auto count = static_cast<double>(trial.size());
        seconds += placed - start + (done - placed) * wanted / count +
                   std::max(0.0, wanted - count) * kSecondsPerPoint;
    }
    JsonValue estimate = JsonValue::object();
    estimate.set("points", points)
        .set("memoryBytes", points * static_cast<double>(kBytesPerPoint))
        .set("seconds", seconds)
        .set("bodies", std::move(bodies));
    return estimate;
}

}  // namespace sss
