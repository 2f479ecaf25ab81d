#include "render_frames.h"

#include "frame_files.h"
#include "frame_record.h"
#include "sss/app/frame_run.h"
#include "sss/app/scene_frames.h"
#include "sss/app/stage_chain.h"
#include "sss/base/error.h"
#include "sss/base/frame_list.h"
#include "sss/base/rng.h"
#include "sss/image/film_memory.h"
#include "sss/integrate/integrator_table.h"
#include "sss/integrate/renderer.h"

#include <fmt/core.h>

namespace {

using namespace sss;

void applyOverrides(Scene& scene, const RenderOptions& options) {
    options.applyTo(scene);
    if (options.integrator) scene.quality.integrator = *options.integrator;
    if (options.samples) scene.film.samples = *options.samples;
    if (options.width) scene.film.width = *options.width;
    if (options.height) scene.film.height = *options.height;
    // A frame of an animation has noise of its own; points never do.
    if (!options.frames.empty())
        scene.quality.cameraSeed = combineSeeds(0xf7a3e, static_cast<std::uint64_t>(scene.frame));
    if (options.cameraSeed) scene.quality.cameraSeed = *options.cameraSeed;
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
        for (const int number : frames) requireWritable(options_, frameOf(options_, number));
        for (std::size_t i = 0; i < frames.size(); ++i) {
            log_.beginFrame(frames[i], i + 1, frames.size());
            render(frameOf(options_, frames[i]), i + 1 == frames.size());
        }
        recordExitance(stats_, exitance_.counts());
        stats_.value("frames", std::move(table_));
    }

private:
    void render(PictureFrame frame, bool isLast) {
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
                .set("stages", toJson(stages))
                .set("cacheBytesNeeded", chain_.cacheBytesNeeded());
            if (options_.explain)
                for (const StageRow& stage : stages)
                    fmt::print("frame {}: {}\n", frame.number, sentenceOf(stage));
        }
        table_.push(std::move(row));
    }

    std::vector<StageRow> make(const PictureFrame& frame, const Scene& scene, bool isLast) {
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
        {
            const auto timer = stats_.seconds("write");
            writePictures(options_, scene, frame, result.image, reporter_);
        }
        recordRender(stats_, scene, result, needsFields, optics);
        std::vector<StageRow> rows = needsFields ? chain_.rows() : std::vector<StageRow>();
        for (StageRow& row : exitance_.finishFrame(isLast)) rows.push_back(std::move(row));
        return rows;
    }

    void prepare(const PictureFrame& frame, const std::shared_ptr<const World>& world,
                 bool sameWorld) {
        const std::filesystem::path file =
            isFolder_ ? std::filesystem::path()
                      : std::filesystem::path(frameName(options_.cache.string(), frame.number));
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
    runFrames("sss-render", options, {},
              [&](TerminalReporter& log, Reporter& reporter, RunStats& stats) {
                  FrameRenderer(options, log, reporter, stats).run();
              });
}
