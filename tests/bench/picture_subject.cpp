// What the classic sums cost at the places that a picture sees, and how wrong they are there.
#include "measure_curve.h"
#include "receivers.h"
#include "sss/integrate/cloud_cache.h"
#include "subjects.h"

namespace sss::bench {
namespace {

BodyCloud cloudOf(const Stage& stage, const std::string& cacheFile) {
    const CloudCache cache(cacheFile, stage.world(), stage.allOptics());
    const BodyCloud::View view = cache.view(0);
    return {{view.cloud.points.begin(), view.cloud.points.end()},
            {view.cloud.irradiance.begin(), view.cloud.irradiance.end()},
            {view.nodes.begin(), view.nodes.end()},
            view.spacingMm,
            {view.solved.begin(), view.solved.end()}};
}

}  // namespace

JsonValue measurePicture(const Arguments& arguments) {
    CurveInput input;
    input.tolerances = arguments.numbers("tolerances", {0.1, 0.01, 0.001});
    input.rounds = static_cast<int>(arguments.number("rounds", 2));
    input.secondsPerSetting = 1;
    const auto count = static_cast<std::size_t>(arguments.number("receivers", 768));
    const std::string cacheFile = arguments.text("cache");
    const std::string truthScene = arguments.text("truth-scene");
    const std::string truthCache = arguments.text("truth-cache");
    arguments.check();

    const Stage stage(readScene(arguments.scene(), Quality{}));
    std::vector<Vec3> places;
    for (const Receiver& r : receiversInView(stage, count)) places.push_back(r.position);
    const Stage truthStage(readScene(truthScene, Quality{}));
    const std::vector<DRgb> truth =
        Hierarchy(truthStage, cloudOf(truthStage, truthCache)).bruteForce(places);
    input.receivers = places;
    input.truth = truth;

    const Hierarchy hierarchy(stage, cloudOf(stage, cacheFile));
    JsonValue json = JsonValue::object();
    json.set("points", hierarchy.cloud.points.size())
        .set("receivers", places.size())
        .set("methods", measureCurves(input, sumMethods(hierarchy)));
    return json;
}

}  // namespace sss::bench
