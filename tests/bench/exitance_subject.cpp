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

// Every face.
std::vector<Receiver> everywhere(const TriangleMesh& mesh) {
    std::vector<Receiver> receivers;
    for (FaceIndex face = 0; face < mesh.faceCount(); ++face)
        receivers.push_back({face, Vec2(1.0f / 3), {}});
    return receivers;
}

// A fresh field, asked at all of these places.
void lookAt(const Stage& stage, const BodyCloud::View& cloud, std::span<const Receiver> receivers,
            Cost& cost) {
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
    const std::vector<Receiver> seen = receiversInView(flat, count),
                                all = everywhere(flat.body().mesh);
    SilentReporter silent;
    BodyReport report;
    const SurfaceSamples samples =
        placePoints(shaped.world(), 0, shaped.optics(), {}, silent, report);
    IrradianceResult light =
        lightPoints(shaped.world(), 0, samples, shaped.allOptics(), silent, report);
    const EnteredBeams beams = beamsInOrder(samples, std::move(light.beams));
    const BodyCloud cloud = buildCloud(samples, std::move(light.irradiance), report);

    Cost profileSeen, profileAll, solution, correctedSeen, correctedAll;
    for (int round = 0; round < rounds; ++round) {
        lookAt(flat, cloud.view(), seen, profileSeen);
        lookAt(flat, cloud.view(), all, profileAll);
        const double began = processSeconds();
        const std::vector<SolvedExitance> solved = shapeSolution(
            shaped.world(), 0, samples, beams, shaped.allOptics(), cloud.view(), silent, report);
        solution.seconds.add(processSeconds() - began);
        const ShapeReport& made = report.shape->report;
        solution.interactions = made.layers.interactions() + made.sources.interactions() +
                                report.shape->profile.interactions();
        BodyCloud::View view = cloud.view();
        view.solved = solved;
        lookAt(shaped, view, seen, correctedSeen);
        lookAt(shaped, view, all, correctedAll);
    }
    const auto pair = [](const Cost& ofSeen, const Cost& ofAll) {
        JsonValue value = JsonValue::object();
        value.set("seen", ofSeen.json()).set("everywhere", ofAll.json());
        return value;
    };
    JsonValue json = JsonValue::object();
    json.set("tolerance", scene.quality.tolerance)
        .set("points", cloud.points.size())
        .set("sums", report.shape->report.layers.sums)
        .set("solution", solution.json())
        .set("profile", pair(profileSeen, profileAll))
        .set("corrected", pair(correctedSeen, correctedAll));
    return json;
}

}  // namespace sss::bench
