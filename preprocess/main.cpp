// sss-preprocess: pass 1. Wiring only; the work is in libsss.
#include "options.h"
#include "sss/app/pass_one.h"
#include "sss/app/program.h"
#include "sss/app/run_stats.h"
#include "sss/app/terminal_reporter.h"
#include "sss/base/atomic_file.h"
#include "sss/base/parallel.h"
#include "sss/cloud/ply_export.h"
#include "sss/integrate/cloud_cache.h"
#include "sss/integrate/preprocess.h"
#include "sss/scene/material_override.h"
#include "sss/scene/scene_reader.h"

#include <fmt/core.h>

namespace {

using namespace sss;

void printNumber(const JsonValue& body, const char* key, const char* format) {
    const JsonMember* found = body.find(key);
    if (found && found->value.isNumber()) fmt::print(fmt::runtime(format), found->value.asNumber());
}

void printInfo(const PreprocessOptions& options) {
    const JsonValue info = describeCache(options.info);
    if (options.json) {
        fmt::print("{}\n", dump(info));
        return;
    }
    for (const JsonMember& m : info.members())
        if (m.value.isString() || m.value.isNumber())
            fmt::print("{:15} {}\n", m.key, dump(m.value, -1));
    const JsonMember* bodies = info.find("bodies");
    if (!bodies || !bodies->value.isArray()) return;
    for (const JsonValue& body : bodies->value.items()) {
        const JsonMember* name = body.isObject() ? body.find("name") : nullptr;
        if (!name) continue;
        fmt::print("body            {}\n", dump(name->value, -1));
        printNumber(body, "points", "  points        {}\n");
        printNumber(body, "nodes", "  nodes         {}\n");
        printNumber(body, "areaMm2", "  area          {:.6g} mm2\n");
        printNumber(body, "spacingMm", "  spacing       {:.4g} mm\n");
        if (const JsonMember* mfp = body.find("meanFreePathMm"))
            fmt::print("  mean free path {} mm\n", dump(mfp->value, -1));
        printNumber(body, "irradianceSamples", "  light samples {} a point\n");
    }
}

void applyOverrides(Scene& scene, const PreprocessOptions& options) {
    if (options.tolerance) scene.quality.tolerance = *options.tolerance;
    if (options.spacingMm) scene.quality.spacingMm = *options.spacingMm;
    if (options.seed) scene.quality.seed = *options.seed;
    if (!options.model.empty()) setModel(scene, options.model, "--model");
    if (options.boundary) setBoundary(scene, *options.boundary);
}

// Points of all bodies, in the world's space moved back to the scene's.
void exportPoints(const std::filesystem::path& path, const World& world,
                  std::span<const BodyCloud> clouds) {
    std::vector<Vec3> positions, normals;
    std::vector<float> areas;
    std::vector<Rgb> irradiances;
    for (std::size_t b = 0; b < clouds.size(); ++b) {
        const RigidTransform& move = world.bodies()[b].worldFromBody;
        for (std::size_t i = 0; i < clouds[b].points.size(); ++i) {
            const SurfacePoint& p = clouds[b].points[i];
            positions.push_back(Vec3(move.transformPoint(DVec3(p.position)) + world.originMm()));
            normals.push_back(Vec3(move.transformDirection(DVec3(decodeUnitVector(p.normal)))));
            areas.push_back(p.areaMm2);
            irradiances.push_back(clouds[b].irradiance[i]);
        }
    }
    exportPly(path, {positions, normals, areas, irradiances});
}

int run(int argc, const char* const* argv) {
    const auto options = readOptions(argc, argv);
    if (!options) return 0;
    if (!options->info.empty()) {
        printInfo(*options);
        return 0;
    }
    RunStats stats("sss-preprocess");
    TerminalOptions terminal;
    terminal.quiet = options->quiet;
    TerminalReporter reporter(terminal);
    const ThreadLimit threads(options->threads);
    for (const auto& output : {options->cache, options->stats, options->exportPly})
        if (!output.empty()) requireWritable(output);

    std::optional<World> world;
    {
        const auto timer = stats.seconds("scene");
        Scene scene = readScene(options->scene, options->metersPerUnit);
        applyOverrides(scene, *options);
        world.emplace(scene, reporter);
    }
    if (world->bodies().empty())
        reporter.warn("scene", "no object is translucent: there is nothing to cache");
    const auto optics = makeBodyOptics(*world);
    const PassOne made = runPassOne(*world, optics, {options->maxPoints}, reporter, stats);
    {
        const auto timer = stats.seconds("write");
        if (!options->exportPly.empty()) exportPoints(options->exportPly, *world, made.clouds);
        writeCloudCache(options->cache, *world, made.clouds, made.reports, optics);
    }
    stats.value("threads", ThreadLimit::current());
    reporter.info(
        "cache",
        fmt::format("wrote {} ({:.3g} MB)", options->cache.string(),
                    static_cast<double>(std::filesystem::file_size(options->cache)) / 1e6));
    if (!options->stats.empty()) stats.writeStats(options->stats);
    if (options->strict) reporter.requireNoWarnings();
    return 0;
}

}  // namespace

int main(int argc, char** argv) { return sss::runProgram("sss-preprocess", argc, argv, run); }
