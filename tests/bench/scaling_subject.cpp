// Cost of a receiver against the number of points.
#include "measure_curve.h"
#include "receivers.h"
#include "sss/cloud/surface_strata.h"
#include "stopwatch.h"
#include "subjects.h"

#include <algorithm>
#include <cmath>

namespace sss::bench {
namespace {

// The body under a lamp and a dim sky, without shadows: what a cloud of any size can be lit with
// in no time.
Rgb lightAt(const Vec3& normal) {
    const Vec3 toLamp = glm::normalize(Vec3(-120, 70, -50));
    return Rgb(0.05f + std::max(0.0f, glm::dot(normal, toLamp)));
}

BodyCloud stratifiedCloud(const TriangleMesh& mesh, std::size_t count, double& buildSeconds) {
    const SurfaceStrata strata = makeStrata(mesh, count, 1);
    BodyCloud cloud;
    cloud.spacingMm = std::sqrt(strata.areaMm2);
    for (const std::uint32_t i : mortonOrder(strata.positions)) {
        const Vec3 normal(glm::normalize(mesh.faceCross(strata.faces[i])));
        SurfacePoint point;
        point.position = strata.positions[i];
        point.areaMm2 = static_cast<float>(strata.areaMm2);
        point.normal = encodeUnitVector(normal);
        point.face = strata.faces[i];
        cloud.points.push_back(point);
        cloud.irradiance.push_back(lightAt(normal));
    }
    const double began = processSeconds();
    cloud.nodes = buildOctree(cloud.view().cloud);
    buildSeconds = processSeconds() - began;
    return cloud;
}

}  // namespace

JsonValue measureScaling(const Arguments& arguments) {
    const std::vector<double> counts = arguments.numbers("points", {1e4, 1e5});
    const auto receiverCount = static_cast<std::size_t>(arguments.number("receivers", 512));
    CurveInput input;
    input.tolerances = arguments.numbers("tolerances", {0.01});
    input.rounds = static_cast<int>(arguments.number("rounds", 3));
    arguments.check();

    const Stage stage(readScene(arguments.scene(), Quality{}));
    const TriangleMesh& mesh = stage.body().mesh;
    // All of them are timed, as a picture of the whole body asks for them; the truth is known at
    // some.
    const double meanFreePathMm = stage.optics().material.medium.smallestMeanFreePathMm();
    const auto every = static_cast<std::size_t>(mesh.area() / (meanFreePathMm * meanFreePathMm));
    const std::vector<Vec3> timed = receiverGroups(mesh, meanFreePathMm, every);
    const std::vector<Vec3> receivers = receiverGroups(mesh, meanFreePathMm, receiverCount);
    JsonValue sizes = JsonValue::array();
    for (const double count : counts) {
        double buildSeconds = 0;
        const Hierarchy hierarchy(
            stage, stratifiedCloud(mesh, static_cast<std::size_t>(count), buildSeconds));
        const std::vector<DRgb> truth = hierarchy.bruteForce(receivers);
        input.receivers = receivers;
        input.timed = timed;
        input.truth = truth;
        std::vector<std::unique_ptr<SumMethod>> ours;
        ours.push_back(ourMethod(hierarchy));
        const BodyCloud& cloud = hierarchy.cloud;
        JsonValue size = JsonValue::object();
        size.set("points", cloud.points.size())
            .set("nodes", cloud.nodes.size())
            .set("spacingMm", cloud.spacingMm)
            .set("octreeCpuSeconds", buildSeconds)
            .set("bytesPerPoint", sizeof(SurfacePoint) + sizeof(Rgb))
            .set("bytesPerNode", sizeof(OctreeNode))
            .set("methods", measureCurves(input, ours));
        sizes.push(std::move(size));
    }
    JsonValue json = JsonValue::object();
    json.set("body", stage.body().name)
        .set("receivers", timed.size())
        .set("checkedReceivers", receivers.size())
        .set("group", kGroup)
        .set("timeUnit", "CPU s per receiver, one thread")
        .set("sizes", std::move(sizes));
    return json;
}

}  // namespace sss::bench
