#include "render_frames.h"

#include "sss/app/scene_frames.h"
#include "sss/app/stage_chain.h"
#include "sss/app/terminal_reporter.h"
#include "sss/base/atomic_file.h"
#include "sss/base/error.h"
#include "sss/base/frame_list.h"
#include "sss/base/parallel.h"
#include "sss/base/rng.h"
#include "sss/image/exr_file.h"
#include "sss/image/film_memory.h"
#include "sss/image/png_file.h"
#include "sss/image/tone_map.h"
#include "sss/integrate/integrator_table.h"
#include "sss/integrate/renderer.h"
#include "sss/scene/material_override.h"

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
    // A frame of an animation has noise of its own; points never do.
    if (!options.frames.empty())
        scene.quality.cameraSeed = combineSeeds(0xf7a3e, static_cast<std::uint64_t>(scene.frame));
    if (options.cameraSeed) scene.quality.cameraSeed = *options.cameraSeed;
}

void addMetadata(LayeredImage& image, const World& world, const Fingerprint& made,
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
    meta["sss/cacheHash"] = made == Fingerprint{} ? std::string("none") : made.hex();
    meta["imageCounter"] = scene.frame;
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

void recordRender(RunStats& stats, const Scene& scene, const RenderResult& result) {
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
}

void recordExitance(RunStats& stats, const ExitanceCounts& total) {
    stats.count("exitanceSites", total.sites);
    stats.count("exitanceGroups", total.groups);
    stats.count("exitanceRefinements", total.refinements);
    stats.count("exitanceUnsettled", total.unsettled);
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

/// Where a frame's files go, and what they must hold.
struct Frame {
    int number = 1;
    std::filesystem::path output, png;
    Fingerprint picture;
};

// The EXR comes last: where it is whole, so is the frame.
void writePictures(const RenderOptions& options, const Scene& scene, const Frame& frame,
                   const LayeredImage& image, Reporter& reporter) {
    std::string files = frame.output.string();
    if (!options.noPng) {
        writePng(frame.png, toneMap(image, scene.film.exposureStops));
        files += " and " + frame.png.string();
    }
    writeExr(frame.output, image, {scene.film.halfPrecision});
    reporter.info("image", "wrote " + files);
}

constexpr const char* kPictureHash = "sss/pictureHash";

// Whether a picture of this very frame is there, whole to its last pixel, and its preview.
bool isComplete(const RenderOptions& options, const Scene& scene, const Frame& frame) {
    std::error_code ignored;
    if (!std::filesystem::exists(frame.output, ignored)) return false;
    if (!options.noPng && !isWholePng(frame.png)) return false;
    try {
        const LayeredImage image = readExr(frame.output);
        const auto hash = image.metadata.find(kPictureHash);
        const auto* text =
            hash == image.metadata.end() ? nullptr : std::get_if<std::string>(&hash->second);
        return text != nullptr && *text == frame.picture.hex() && image.width == scene.film.width &&
               image.height == scene.film.height;
    } catch (const Error&) {
        return false;
    }
}

std::filesystem::path named(const std::filesystem::path& pattern, int frame) {
    return frameName(pattern.string(), frame);
}

class FrameRenderer {
public:
    FrameRenderer(const RenderOptions& options, TerminalReporter& log, Reporter& reporter,
                  RunStats& stats)
        : options_(options),
          log_(log),
          reporter_(reporter),
          stats_(stats),
          scenes_(
              options.scene, options.metersPerUnit,
              [&](Scene& scene) { applyOverrides(scene, options); }, reporter),
          isFolder_(isStageFolder(options.cache)),
          chain_({isFolder_ ? options.cache : std::filesystem::path(),
                  {options.maxPoints},
                  options.cacheOnly,
                  false,
                  options.explain,
                  true},
                 reporter, stats),
          exitance_(options.noKeep ? nullptr : chain_.folder(), reporter, stats) {}

    void run() {
        const std::vector<int> frames = options_.frames.empty() ? std::vector{1} : options_.frames;
        for (const int number : frames) requireWritableOutputs(frameOf(number));
        for (std::size_t i = 0; i < frames.size(); ++i) {
            log_.beginFrame(frames[i], i + 1, frames.size());
            render(frameOf(frames[i]), i + 1 == frames.size());
        }
        recordExitance(stats_, exitance_.counts());
        stats_.value("frames", std::move(table_));
    }

private:
    Frame frameOf(int number) const {
        Frame frame{number, named(options_.output, number), {}, {}};
        frame.png = frame.output;
        frame.png.replace_extension(".png");
        return frame;
    }

    void requireWritableOutputs(const Frame& frame) const {
        requireWritable(frame.output);
        if (!options_.noPng) requireWritable(frame.png);
    }

    void render(Frame frame, bool isLast) {
        const Scene scene = scenes_.at(frame.number);
        frame.picture = scenes_.pictureFingerprint(scene);
        JsonValue row = JsonValue::object();
        row.set("frame", frame.number).set("output", frame.output.string());
        const bool isSkipped = options_.resume && isComplete(options_, scene, frame);
        row.set("skipped", isSkipped);
        if (isSkipped) {
            reporter_.info("frame",
                           fmt::format("{} is complete: {}", frame.number, frame.output.string()));
            if (isLast) exitance_.finishFrame(true);
        } else {
            const double wall = stats_.wallSeconds(), cpu = stats_.cpuSeconds();
            const std::vector<StageRow> stages = make(frame, scene, isLast);
            row.set("seconds", stats_.wallSeconds() - wall)
                .set("cpuSeconds", stats_.cpuSeconds() - cpu)
                .set("stages", toJson(stages));
            if (options_.explain)
                for (const StageRow& stage : stages)
                    fmt::print("frame {}: {}\n", frame.number, sentenceOf(stage));
        }
        table_.push(std::move(row));
    }

    std::vector<StageRow> make(const Frame& frame, const Scene& scene, bool isLast) {
        if (!options_.frames.empty())
            reporter_.info("frame", fmt::format("{} of {}", frame.number, scene.file.string()));
        requireFilmMemory(scene.film.width, scene.film.height, scene.film.layers);
        std::shared_ptr<const World> world;
        bool sameWorld = false;
        {
            const auto timer = stats_.seconds("scene");
            world = scenes_.world(scene, sameWorld);
        }
        const bool needsFields = integratorOf(scene).needsFields;
        if (!needsFields && !options_.cache.empty())
            throw Error(ErrorKind::Usage, "--cache",
                        fmt::format("the integrator \"{}\" uses none", scene.quality.integrator),
                        "leave it out");
        if (!needsFields) {
            if (!sameWorld) plainOptics_ = makeBodyOptics(*world);
        } else {
            prepare(frame, world, sameWorld);
        }
        RenderResult result;
        std::span<const std::unique_ptr<BodyField>> fields;
        const auto optics = needsFields ? chain_.optics() : std::span(std::as_const(plainOptics_));
        {
            const auto timer = stats_.seconds("render");
            if (needsFields)
                fields = exitance_.fields(chain_.fieldInputs(), scene.quality.tolerance, beside_);
            result = sss::render(*world, optics, fields, reporter_);
        }
        warnOfFlaws(result, reporter_);
        addMetadata(result.image, *world, needsFields ? chain_.fingerprint() : Fingerprint{},
                    optics);
        result.image.metadata[kPictureHash] = frame.picture.hex();
        {
            const auto timer = stats_.seconds("write");
            writePictures(options_, scene, frame, result.image, reporter_);
        }
        recordRender(stats_, scene, result);
        recordSkips(stats_, result.counts, needsFields, optics);
        std::vector<StageRow> rows = needsFields ? chain_.rows() : std::vector<StageRow>();
        for (StageRow& row : exitance_.finishFrame(isLast)) rows.push_back(std::move(row));
        return rows;
    }

    void prepare(const Frame& frame, const std::shared_ptr<const World>& world, bool sameWorld) {
        const std::filesystem::path file =
            isFolder_ ? std::filesystem::path() : named(options_.cache, frame.number);
        if (sameWorld && file == openFile_) {
            chain_.reuse();
            return;
        }
        const World* reference = scenes_.reference(world->scene());
        openFile_ = file;
        if (file.empty()) {
            chain_.prepare(world, reference);
            return;
        }
        const auto timer = stats_.seconds("cache");
        chain_.open(file, world, reference);
        if (!options_.noKeep) beside_ = file;
    }

    const RenderOptions& options_;
    TerminalReporter& log_;
    Reporter& reporter_;
    RunStats& stats_;
    SceneFrames scenes_;
    bool isFolder_;
    StageChain chain_;
    ExitanceChain exitance_;
    std::vector<std::unique_ptr<BodyOptics>> plainOptics_;  // of an integrator without pass 1
    std::filesystem::path openFile_, beside_;
    JsonValue table_ = JsonValue::array();
};

}  // namespace

void renderFrames(const RenderOptions& options) {
    RunStats stats("sss-render");
    TerminalOptions terminal;
    terminal.quiet = options.quiet;
    terminal.progress = options.progress;
    TerminalReporter log(terminal);
    OnceReporter reporter(log);
    const ThreadLimit threads(options.threads);
    if (!options.stats.empty()) requireWritable(options.stats);
    FrameRenderer(options, log, reporter, stats).run();
    stats.value("threads", ThreadLimit::current());
    if (!options.stats.empty()) stats.writeStats(options.stats);
    if (options.strict) log.requireNoWarnings();
}
