#include "measure_curve.h"
#include "receivers.h"
#include "subjects.h"

namespace sss::bench {

JsonValue measureHierarchy(const Arguments& arguments) {
    CurveInput input;
    input.tolerances = arguments.numbers("tolerances", {0.1, 0.01, 0.001, 0.0001});
    input.rounds = static_cast<int>(arguments.number("rounds", 3));
    const auto receiverCount = static_cast<std::size_t>(arguments.number("receivers", 1024));
    const Quality quality{.spacingMm = arguments.number("spacing", 0),
                          .tolerance = arguments.number("pass-one-tolerance", 0)};
    arguments.check();

    const Stage stage(readScene(arguments.scene(), quality));
    Stage::Made made = stage.makeCloud();
    const Hierarchy hierarchy(stage, std::move(made.cloud));
    const std::vector<Vec3> receivers = receiverGroups(
        stage.body().mesh, stage.optics().material.medium.smallestMeanFreePathMm(), receiverCount);
    const std::vector<DRgb> truth = hierarchy.bruteForce(receivers);
    input.receivers = receivers;
    input.truth = truth;

    JsonValue json = JsonValue::object();
    json.set("body", stage.body().name)
        .set("points", made.report.points)
        .set("nodes", made.report.nodes)
        .set("spacingMm", made.report.spacingMm)
        .set("smallestMeanFreePathMm", stage.optics().material.medium.smallestMeanFreePathMm())
        .set("receivers", receivers.size())
        .set("group", kGroup)
        .set("instructionSet", accumulateTarget())
        .set("timeUnit", "CPU s per receiver, one thread")
        .set("reference", "sum over the same points in double")
        .set("methods", measureCurves(input, sumMethods(hierarchy)));
    return json;
}

}  // namespace sss::bench
