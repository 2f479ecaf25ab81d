#include "sss/app/estimate.h"

#include "sss/app/placed_on.h"
#include "sss/base/stopwatch.h"
#include "sss/integrate/scene_fingerprint.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

constexpr double kTrialPoints = 2000;
// Placing a point, of one thread; on top of what the trial says.
constexpr double kSecondsPerPoint = 10e-6;

}  // namespace

PassOneEstimate::Trial PassOneEstimate::tryOut(const World& light, int bodyIndex,
                                               std::span<const std::unique_ptr<BodyOptics>> optics,
                                               double wanted, double spacingMm) const {
    SilentReporter silent;
    const auto b = static_cast<std::size_t>(bodyIndex);
    const Body& body = light.bodies()[b];
    SamplerOptions sampling;
    sampling.spacingMm = std::max(spacingMm, std::sqrt(body.mesh.area() / kTrialPoints));
    const Stopwatch placing;
    const SurfaceSamples trial = sampleSurface(body.mesh, sampling);
    const double placingSeconds = placing.seconds();
    const Stopwatch lighting;
    BodyReport report;
    describePoints(body, *optics[b], trial.size(), report);
    IrradianceResult lit = lightPoints(light, bodyIndex, trial, optics, silent, report);
    if (optics[b]->onShape) {
        BodyCloud cloud = buildCloud(trial, std::move(lit.irradiance), report);
        cloud.spacingMm = spacingMm;  // too far apart, nothing would be solved
        shapeSolution(light, bodyIndex, trial, lit.beams, optics, cloud.view(), silent, report);
    }
    const auto count = static_cast<double>(trial.size());
    return {placingSeconds + std::max(0.0, wanted - count) * kSecondsPerPoint,
            lighting.seconds() * wanted / count};
}

void PassOneEstimate::add(const World& world, const World* reference) {
    const auto optics = makeBodyOptics(world);
    std::unique_ptr<const World> light;  // made when needed
    double inFrame = 0;
    for (std::size_t b = 0; b < optics.size(); ++b) {
        const Body& body = world.bodies()[b];
        const TriangleMesh* placed = placedOn(reference, body, b);
        const double spacing = pointSpacingMm(world, body, *optics[b]);
        const auto wanted = static_cast<double>(expectedPoints(world, body, *optics[b], placed));
        const BodyInputs inputs = bodyInputs(world, static_cast<int>(b), optics, spacing, placed);
        inFrame += wanted;
        const auto [trial, isNew] = trials_.try_emplace(pointsFingerprint(inputs).hex());
        if (isNew) {
            if (!light) light = world.inLightSpace();
            trial->second = tryOut(*light, static_cast<int>(b), optics, wanted, spacing);
            points_ += wanted;
            seconds_ += trial->second.secondsToPlace;
            JsonValue entry = JsonValue::object();
            entry.set("name", body.name).set("points", wanted).set("spacingMm", spacing);
            bodies_.push(std::move(entry));
        }
        if (lit_.insert(shapeFingerprint(inputs).hex()).second)
            seconds_ += trial->second.secondsToLight;
    }
    mostPoints_ = std::max(mostPoints_, inFrame);
}

JsonValue PassOneEstimate::total() const {
    JsonValue estimate = JsonValue::object();
    estimate.set("points", points_)
        .set("memoryBytes", mostPoints_ * static_cast<double>(kBytesPerPoint))
        .set("seconds", seconds_)
        .set("bodies", bodies_);
    return estimate;
}

}  // namespace sss
