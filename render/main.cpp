// sss-render: pass 2. Wiring only; the work is in libsss.
#include "list_materials.h"
#include "options.h"
#include "print_profile.h"
#include "sss/app/pass_one.h"
#include "sss/app/program.h"
#include "sss/app/run_stats.h"
#include "sss/app/terminal_reporter.h"
#include "sss/base/atomic_file.h"
#include "sss/base/error.h"
#include "sss/base/parallel.h"
#include "sss/image/exr_file.h"
#include "sss/image/png_file.h"
#include "sss/image/tone_map.h"
#include "sss/integrate/cloud_cache.h"
#include "sss/integrate/diffuse_limit.h"
#include "sss/integrate/exitance_cache.h"
#include "sss/integrate/integrator_table.h"
#include "sss/integrate/renderer.h"
#include "sss/scene/material_override.h"
#include "sss/scene/scene_reader.h"

#include <fmt/core.h>

namespace {

using namespace sss;

void applyOverrides(Scene& scene, const RenderOptions& options) {
    if (options.tolerance) scene.quality.tolerance = *options.tolerance;
    if (options.integrator) scene.quality.integrator = *options.integrator;
    if (options.seed) scene.quality.seed = *options.seed;
    if (options.samples) scene.film.samples = *options.samples;
    if (options.width) scene.film.width = *options.width;
    if (options.height) scene.film.height = *options.height;
    if (!options.profile.model.empty()) setModel(scene, options.profile.model, "--model");
    if (options.profile.boundary) setBoundary(scene, *options.profile.boundary);
}

// What a body's field is summed over: a cache file's sections, or clouds made just now.
struct Clouds {
    std::optional<CloudCache> cache;
    PassOne made;
    BodyCloud::View view(std::size_t body) const {
        return cache ? cache->view(body) : made.clouds[body].view();
    }
};

void addMetadata(LayeredImage& image, const World& world, const Clouds& clouds,
                 std::span<const std::unique_ptr<BodyOptics>> optics) {
    const Scene& scene = world.scene();
    auto& meta = image.metadata;
    meta["Software"] = std::string("sss-render " SSS_VERSION);
    meta["sss/version"] = std::string(SSS_VERSION);
    meta["sss/scene"] = scene.file.filename().string();
    meta["sss/spp"] = scene.film.samples;
    meta["samplesPerPixel"] = scene.film.samples;
    meta["sss/seed"] = static_cast<double>(scene.quality.seed);
    meta["sss/metersPerUnit"] = scene.metersPerUnit;
    meta["sss/tolerance"] = scene.quality.tolerance;
    meta["sss/cacheHash"] = clouds.cache
                                ? clouds.cache->fingerprint()
                                : std::string(clouds.made.clouds.empty() ? "none" : "in memory");
    meta["sss/integrator"] = scene.quality.integrator;
    meta["colorInteropID"] = std::string("lin_rec709_scene");
    std::string paths;
    for (std::size_t b = 0; b < optics.size(); ++b) {
        const DRgb mfp = optics[b]->material.medium.meanFreePathMm();
        paths += fmt::format("{}{} {:.4g} {:.4g} {:.4g}", b ? "; " : "", world.bodies()[b].name,
                             mfp.x, mfp.y, mfp.z);
    }
    meta["sss/mfp_mm"] = paths;
    meta["worldToCamera"] = world.camera().worldToCamera();
    meta["worldToNDC"] = world.camera().worldToNdc();
}

void recordRender(RunStats& stats, const Scene& scene, const RenderResult& result,
                  std::span<const std::unique_ptr<BodyField>> fields) {
    stats.count("cameraSamples", result.counts.cameraSamples);
    stats.count("rays", result.counts.rays);
    stats.count("diffusionEvaluations", result.counts.diffusionLookups);
    stats.count("singleScatteringSamples", result.counts.singleSamples);
    stats.count("scatterings", result.counts.scatterings);
    stats.count("volumeStretches", result.counts.volumeStretches);
    stats.count("leaks", result.counts.leaks);
    stats.count("lostPaths", result.counts.lost);
    stats.value("integrator", scene.quality.integrator);
    stats.count("nan", result.dropped.samples);
    ExitanceCounts total;
    for (const auto& field : fields) {
        if (!field) continue;
        const ExitanceCounts counts = field->counts();
        total.sums.add(counts.sums);
        total.groups += counts.groups;
        total.sites += counts.sites;
        total.refinements += counts.refinements;
    }
    stats.count("exitanceSites", total.sites);
    stats.count("exitanceGroups", total.groups);
    stats.count("exitanceRefinements", total.refinements);
    stats.count("sumReceivers", total.sums.receivers);
    stats.count("localInteractions", total.sums.localInteractions);
    stats.count("nodeInteractions", total.sums.nodeInteractions);
    stats.count("pointInteractions", total.sums.pointInteractions);
    stats.count("skippedNodes", total.sums.nodesSkipped);
    stats.count("skippedPoints", total.sums.pointsSkipped);
    stats.value("instructionSet", accumulateTarget());
}

// What was left out because it brings nothing, or is known already.
void recordSkips(RunStats& stats, const PathCounts& counts, bool needsFields,
                 std::span<const std::unique_ptr<BodyOptics>> optics) {
    int equalChannels = 0;
    std::uint64_t limits = 0;
    for (const auto& body : optics) {
        equalChannels += body->equalChannels();
        limits += body->inDiffuseLimit ? 1 : 0;
    }
    stats.count("equalChannels", static_cast<std::uint64_t>(equalChannels));
    stats.count("diffuseLimitBodies", limits);
    stats.count("passOneSkipped", needsFields && limits < optics.size() ? 0 : 1);
    stats.count("singleScatteringSkipped", counts.singleSkipped);
}

// Share of the paths that may meet a surface where none should be, by rounding.
constexpr double kUsualLeaks = 0.01;

void warnOfFlaws(const RenderResult& result, Reporter& reporter) {
    if (result.dropped.samples > 0)
        reporter.warn(
            "render",
            fmt::format("{} camera samples were not finite and were left out, the first "
                        "in pixel {}, {}",
                        result.dropped.samples, result.dropped.firstX, result.dropped.firstY));
    const PathCounts& counts = result.counts;
    if (static_cast<double>(counts.leaks) > kUsualLeaks * static_cast<double>(counts.cameraSamples))
        reporter.warn("render",
                      fmt::format("{} times in {} paths, light inside a body met a face from "
                                  "outside, or found no way out: the body's meshes cut each other "
                                  "or have holes, and light goes astray there",
                                  counts.leaks, counts.cameraSamples));
    if (counts.lost > 0)
        reporter.warn("render", fmt::format("{} paths did not end and were cut", counts.lost));
}

void writePictures(const RenderOptions& options, const Scene& scene, const LayeredImage& image,
                   Reporter& reporter) {
    writeExr(options.output, image, {scene.film.halfPrecision});
    std::string files = options.output.string();
    if (!options.noPng) {
        std::filesystem::path png = options.output;
        png.replace_extension(".png");
        writePng(png, toneMap(image, scene.film.exposureStops));
        files += " and " + png.string();
    }
    reporter.info("image", "wrote " + files);
}

void requireWritableOutputs(const RenderOptions& options) {
    requireWritable(options.output);
    if (!options.stats.empty()) requireWritable(options.stats);
    if (options.noPng) return;
    std::filesystem::path png = options.output;
    requireWritable(png.replace_extension(".png"));
}

int run(int argc, const char* const* argv) {
    const auto options = readOptions(argc, argv);
    if (!options) return 0;
    if (options->listMaterials) {
        listMaterials(options->compare.json);
        return 0;
    }
    if (!options->compare.files.empty()) {
        comparePictures(options->compare);
        return 0;
    }
    if (!options->profile.material.empty()) {
        printProfile(options->profile, options->metersPerUnit);
        return 0;
    }
    RunStats stats("sss-render");
    TerminalOptions terminal;
    terminal.quiet = options->quiet;
    TerminalReporter reporter(terminal);
    const ThreadLimit threads(options->threads);
    requireWritableOutputs(*options);

    std::optional<World> world;
    {
        const auto timer = stats.seconds("scene");
        Scene scene = readScene(options->scene, options->metersPerUnit);
        applyOverrides(scene, *options);
        world.emplace(scene, reporter);
    }
    const auto optics = makeBodyOptics(*world);
    const bool needsFields = integratorOf(world->scene()).needsFields;
    if (needsFields) findDiffuseLimits(*world, optics, reporter);
    if (!needsFields && !options->cache.empty())
        throw Error(
            ErrorKind::Usage, "--cache",
            fmt::format("the integrator \"{}\" uses none", world->scene().quality.integrator),
            "leave it out");
    Clouds clouds;
    if (!needsFields) {
        // Nothing is summed.
    } else if (!options->cache.empty()) {
        const auto timer = stats.seconds("cache");
        clouds.cache.emplace(options->cache, *world, optics);
    } else {
        clouds.made = runPassOne(*world, optics, {options->maxPoints}, reporter, stats);
    }
    std::vector<std::unique_ptr<BodyField>> fields;
    std::optional<ExitanceCache> kept;
    RenderResult result;
    {
        const auto timer = stats.seconds("render");
        for (std::size_t b = 0; needsFields && b < world->bodies().size(); ++b)
            fields.push_back(optics[b]->inDiffuseLimit
                                 ? nullptr
                                 : std::make_unique<BodyField>(world->bodies()[b], *optics[b],
                                                               clouds.view(b),
                                                               world->scene().quality.tolerance));
        if (clouds.cache && !options->noKeep) {
            kept.emplace(options->cache, *world, optics);
            stats.count("exitanceGroupsReused", kept->load(fields, reporter));
        }
        result = render(*world, optics, fields, reporter);
    }
    warnOfFlaws(result, reporter);
    addMetadata(result.image, *world, clouds, optics);
    {
        const auto timer = stats.seconds("write");
        writePictures(*options, world->scene(), result.image, reporter);
        if (kept) kept->save(fields, reporter);
    }
    recordRender(stats, world->scene(), result, fields);
    recordSkips(stats, result.counts, needsFields, optics);
    stats.value("threads", ThreadLimit::current());
    if (!options->stats.empty()) stats.writeStats(options->stats);
    if (options->strict) reporter.requireNoWarnings();
    return 0;
}

}  // namespace

int main(int argc, char** argv) { return sss::runProgram("sss-render", argc, argv, run); }
