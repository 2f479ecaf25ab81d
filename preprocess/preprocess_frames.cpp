#include "preprocess_frames.h"

#include "sss/app/estimate.h"
#include "sss/app/frame_run.h"
#include "sss/app/scene_frames.h"
#include "sss/app/stage_chain.h"
#include "sss/base/atomic_file.h"
#include "sss/base/frame_list.h"
#include "sss/cloud/ply_export.h"

#include <fmt/core.h>

#include <array>

namespace {

using namespace sss;

void applyOverrides(Scene& scene, const PreprocessOptions& options) {
    options.applyTo(scene);
    if (options.spacingMm) scene.quality.spacingMm = *options.spacingMm;
}

// Points of all bodies, in the world's space moved back to the scene's.
void exportPoints(const std::filesystem::path& path, const World& world,
                  std::span<const CachedBody> clouds) {
    std::vector<Vec3> positions, normals;
    std::vector<float> areas;
    std::vector<Rgb> irradiances;
    for (std::size_t b = 0; b < clouds.size(); ++b) {
        clouds[b].cloud.cloud.needAll();
        const RigidTransform& move = world.bodies()[b].worldFromBody;
        for (std::size_t i = 0; i < clouds[b].cloud.cloud.points.size(); ++i) {
            const SurfacePoint& p = clouds[b].cloud.cloud.points[i];
            positions.push_back(Vec3(move.transformPoint(DVec3(p.position)) + world.originMm()));
            normals.push_back(Vec3(move.transformDirection(DVec3(decodeUnitVector(p.normal)))));
            areas.push_back(p.areaMm2);
            irradiances.push_back(clouds[b].cloud.cloud.irradiance[i]);
        }
    }
    exportPly(path, {positions, normals, areas, irradiances});
}

void printEstimate(const JsonValue& estimate, bool json) {
    if (json) {
        fmt::print("{}\n", dump(estimate));
        return;
    }
    const auto number = [&](const char* key) { return estimate.find(key)->value.asNumber(); };
    fmt::print("points  {:.0f}\nmemory  {:.3g} MB\ntime    {:.3g} s\n", number("points"),
               number("memoryBytes") / 1e6, number("seconds"));
}

class FramePreprocessor {
public:
    FramePreprocessor(const PreprocessOptions& options, TerminalReporter& log, Reporter& reporter,
                      RunStats& stats)
        : options_(options),
          log_(log),
          reporter_(reporter),
          stats_(stats),
          scenes_(
              options.scene, options.metersPerUnit,
              [&](Scene& scene) { applyOverrides(scene, options); }, reporter),
          isFolder_(isFolderName(options.cache)),
          // An estimate leaves no folder behind.
          chain_({isFolder_ && !options.printEstimate ? options.cache : std::filesystem::path(),
                  {options.maxPoints},
                  false,
                  true,
                  options.explain,
                  false,
                  true},
                 reporter, stats) {}

    void run() {
        const std::vector<int> frames = options_.frames.empty() ? std::vector{1} : options_.frames;
        if (options_.printEstimate) {
            printEstimate(estimate(frames), options_.json);
            return;
        }
        if (!isFolder_)
            for (const int frame : frames) requireWritable(fileOf(frame));
        for (std::size_t i = 0; i < frames.size(); ++i) {
            log_.beginFrame(frames[i], i + 1, frames.size());
            preprocess(frames[i]);
        }
        stats_.value("frames", std::move(table_));
    }

private:
    std::filesystem::path fileOf(int frame) const {
        return frameName(options_.cache.string(), frame);
    }

    JsonValue estimate(const std::vector<int>& frames) {
        PassOneEstimate sum;
        for (const int frame : frames) {
            const Scene scene = scenes_.at(frame);
            bool sameWorld = false;
            const std::shared_ptr<const World> world = scenes_.world(scene, sameWorld);
            if (!sameWorld) sum.add(*world, scenes_.reference(scene));
        }
        return sum.total();
    }

    void preprocess(int number) {
        const Scene scene = scenes_.at(number);
        if (!options_.frames.empty())
            reporter_.info("frame", fmt::format("{} of {}", number, scene.file.string()));
        const double wall = stats_.wallSeconds(), cpu = stats_.cpuSeconds();
        std::shared_ptr<const World> world;
        bool sameWorld = false;
        {
            const auto timer = stats_.seconds("scene");
            world = scenes_.world(scene, sameWorld);
        }
        if (world->bodies().empty())
            reporter_.warn("scene", "no object is translucent: there is nothing to cache");
        if (sameWorld)
            chain_.reuse();
        else
            chain_.prepare(world, scenes_.reference(scene));
        if (!options_.exportPly.empty())
            exportPoints(frameName(options_.exportPly.string(), number), *world, chain_.clouds());
        if (!isFolder_) write(fileOf(number), *world);
        JsonValue row = JsonValue::object();
        row.set("frame", number)
            .set("seconds", stats_.wallSeconds() - wall)
            .set("cpuSeconds", stats_.cpuSeconds() - cpu)
            .set("stages", toJson(chain_.rows()));
        table_.push(std::move(row));
        if (!options_.explain) return;
        for (const StageRow& stage : chain_.rows())
            fmt::print("frame {}: {}\n", number, sentenceOf(stage));
    }

    void write(const std::filesystem::path& file, const World& world) {
        const auto timer = stats_.seconds("write");
        writeCloudCache(file, world, chain_.clouds());
        reporter_.info("cache",
                       fmt::format("wrote {} ({:.3g} MB)", file.string(),
                                   static_cast<double>(std::filesystem::file_size(file)) / 1e6));
    }

    const PreprocessOptions& options_;
    TerminalReporter& log_;
    Reporter& reporter_;
    RunStats& stats_;
    SceneFrames scenes_;
    bool isFolder_;
    StageChain chain_;
    JsonValue table_ = JsonValue::array();
};

}  // namespace

void preprocessFrames(const PreprocessOptions& options) {
    runFrames("sss-preprocess", options, std::array{options.exportPly},
              [&](TerminalReporter& log, Reporter& reporter, RunStats& stats) {
                  FramePreprocessor(options, log, reporter, stats).run();
              });
}
