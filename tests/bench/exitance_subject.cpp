// What the exitance that a picture shows costs, by the profile and by diffusion on the shape.
#include "receivers.h"
#include "sss/integrate/body_field.h"
#include "stopwatch.h"
#include "subjects.h"

#include <variant>

namespace sss::bench {
namespace {

// Seconds of the process, of several runs, and what was done in each.
struct Cost {
    Repeats seconds;
    std::uint64_t interactions = 0;

    JsonValue json() const {
        JsonValue value = JsonValue::object();
        value.set("seconds", seconds.least())
            .set("secondsMedian", seconds.median())
            .set("interactions", interactions);
        return value;
    }
};

Scene onShape(Scene scene) {
    for (NamedMaterial& named : scene.materials)
        if (auto* material = std::get_if<TranslucentMaterial>(&named.material))
            material->onShape = true;
    return scene;
}

// A fresh field, asked for everything that is seen.
void lookEverywhere(const Stage& stage, const BodyCloud::View& cloud,
                    std::span<const Receiver> receivers, Cost& cost) {
    const double began = processSeconds();
    const BodyField field(stage.body(), stage.optics(), cloud,
                          stage.world().scene().quality.tolerance);
    for (const Receiver& receiver : receivers) field.exitance(receiver.face, receiver.barycentrics);
    cost.seconds.add(processSeconds() - began);
    cost.interactions = field.counts().sums.interactions();
}

}  // namespace

JsonValue measureExitance(const Arguments& arguments) {
    const auto count = static_cast<std::size_t>(arguments.number("receivers", 65536));
    const int rounds = static_cast<int>(arguments.number("rounds", 3));
    arguments.check();

    const Scene scene = readScene(arguments.scene(), Quality{});
    const Stage flat(scene), shaped(onShape(scene));
    const std::vector<Receiver> receivers = receiversInView(flat, count);
    SilentReporter silent;
    BodyReport report;
    const SurfaceSamples samples =
        placePoints(shaped.world(), 0, shaped.optics(), {}, silent, report);
    IrradianceResult light =
        lightPoints(shaped.world(), 0, samples, shaped.allOptics(), silent, report);
    const EnteredBeams beams = beamsInOrder(samples, std::move(light.beams));
    const BodyCloud cloud = buildCloud(samples, std::move(light.irradiance), report);

    Cost profile, solution, corrected;
    for (int round = 0; round < rounds; ++round) {
        lookEverywhere(flat, cloud.view(), receivers, profile);
        const double began = processSeconds();
        const std::vector<SolvedExitance> solved = shapeSolution(
            shaped.world(), 0, samples, beams, shaped.allOptics(), cloud.view(), silent, report);
        solution.seconds.add(processSeconds() - began);
        const ShapeReport& made = report.shape->report;
        solution.interactions = made.layers.interactions() + made.sources.interactions() +
                                report.shape->profile.interactions();
        BodyCloud::View view = cloud.view();
        view.solved = solved;
        lookEverywhere(shaped, view, receivers, corrected);
    }
    JsonValue json = JsonValue::object();
    json.set("tolerance", scene.quality.tolerance)
        .set("points", cloud.points.size())
        .set("receivers", receivers.size())
        .set("iterations", report.shape->report.solve.iterations)
        .set("profile", profile.json())
        .set("solution", solution.json())
        .set("corrected", corrected.json());
    return json;
}

}  // namespace sss::bench
