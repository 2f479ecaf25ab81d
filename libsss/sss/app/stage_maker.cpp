// How the stages of a body are found or made: StageChain's members that do so.
#include "sss/app/stage_state.h"
#include "sss/base/error.h"

#include <fmt/core.h>

#include <algorithm>

namespace sss {
namespace {

// Bytes of a file that is checked as a whole before it is used, so that a damaged one can be made
// anew: that takes some milliseconds. Of larger ones only what is needed is read.
constexpr std::uint64_t kCheckedWhole = std::uint64_t{32} << 20;

// Of how many files --explain looks for the one that differs least.
constexpr std::size_t kFilesExplained = 16;

std::vector<std::string_view> keysOf(Stage stage) {
    switch (stage) {
        case Stage::Points:
            return pointsKeys();
        case Stage::Irradiance:
        case Stage::Beams:
            return lightKeys();
        case Stage::Correction:
        case Stage::Exitance:
            break;
    }
    return {};
}

/// The inputs that a cache file says it was made from, in the words of `like`.
BodyInputs storedInputs(const JsonValue& meta, const BodyInputs& like, const std::string& where) {
    BodyInputs stored = like;
    const JsonValue& hashes = metaMember(meta, "inputs", where);
    for (InputFingerprint& input : stored) {
        const JsonMember* hex = hashes.isObject() ? hashes.find(input.key) : nullptr;
        if (!hex || !hex->value.isString() || hex->value.asString() != input.value.hex())
            input.value = {};
    }
    return stored;
}

}  // namespace

void StageChain::bring(std::size_t b) {
    BodyStage& stage = *stages_[b];
    if (!stage.hasLight && !takeLight(b)) makeLight(b);
    if (now_->optics[b]->onShape) bringShape(b);
}

bool StageChain::takeLight(std::size_t b) {
    if (!folder_) return false;
    const auto timer = stats_.seconds("cache");
    BodyStage& stage = *stages_[b];
    auto file = options_.checkWhole
                    ? folder_->open(Stage::Irradiance, stage.light, reporter_)
                    : folder_->open(Stage::Irradiance, stage.light, reporter_, kCheckedWhole);
    if (!file) return false;
    const std::string where = file->path().string();
    stage.report = reportOf(metadataOf(*file), where);
    stage.file = std::make_shared<CacheFile>(std::move(*file));
    stage.view = cloudOf(*stage.file, 0, stage.report.spacingMm);
    stage.hasLight = true;
    return true;
}

// --cache-only makes nothing.
void StageChain::requireMayMake(std::size_t b, Stage stage) const {
    if (options_.only)
        throw Error(ErrorKind::BadInput, options_.folder.string(),
                    fmt::format("has no {} for \"{}\" in frame {}: {}", stageName(stage),
                                now_->world->bodies()[b].name, now_->world->scene().frame,
                                whyNot(b, stage)),
                    "run sss-preprocess on this scene and frame, or leave out --cache-only");
}

void StageChain::makeLight(std::size_t b) {
    BodyStage& stage = *stages_[b];
    requireMayMake(b, Stage::Irradiance);
    StageFolder::Lock lock;
    if (folder_) {
        lock = folder_->lock(Stage::Irradiance, stage.light, [&] {
            reporter_.info("cache", fmt::format("{}: another process is at it, waiting",
                                                now_->world->bodies()[b].name));
        });
        if (takeLight(b)) return;
    }
    stage.whyLight = whyNot(b, Stage::Irradiance);
    stage.whyOctree = "its irradiance was made";
    auto samples = std::make_shared<const SurfaceSamples>(points(b));
    IrradianceResult lit = light(b, *samples);
    {
        const auto timer = stats_.seconds("octree");
        stage.made = std::make_shared<const BodyCloud>(
            buildCloud(*samples, std::move(lit.irradiance), stage.report));
    }
    stage.view = stage.made->view();
    stage.hasLight = true;
    if (now_->optics[b]->onShape) {
        stage.lit = samples;
        stage.beams =
            std::make_shared<const EnteredBeams>(beamsInOrder(*samples, std::move(lit.beams)));
        write(b, Stage::Beams, stage.report,
              [&](CacheWriter& writer) { addBeams(writer, stage.inputs, *stage.beams); });
    }
    write(b, Stage::Irradiance, stage.report,
          [&](CacheWriter& writer) { addCloud(writer, 0, stage.inputs, stage.view); });
}

IrradianceResult StageChain::light(std::size_t b, const SurfaceSamples& samples) {
    const auto timer = stats_.seconds("irradiance");
    return lightPoints(lightSpace(), static_cast<int>(b), samples, now_->optics, reporter_,
                       stages_[b]->report);
}

const World& StageChain::lightSpace() {
    if (!light_) light_ = now_->world->inLightSpace();
    return *light_;
}

SurfaceSamples StageChain::points(std::size_t b) {
    BodyStage& stage = *stages_[b];
    const Body& body = now_->world->bodies()[b];
    const TriangleMesh& mesh = stage.placedOn != nullptr ? *stage.placedOn : body.mesh;
    std::optional<SurfaceSamples> samples;
    const auto find = [&] {
        if (stage.samples) {
            samples = *stage.samples;
        } else if (folder_) {
            const auto timer = stats_.seconds("cache");
            if (const auto file = folder_->open(Stage::Points, stage.points, reporter_))
                samples = samplesOf(*file, mesh.faceCount());
        }
        return samples.has_value();
    };
    if (!find()) {
        StageFolder::Lock lock;
        if (folder_) lock = folder_->lock(Stage::Points, stage.points, [] {});
        if (!folder_ || !find()) {
            const auto timer = stats_.seconds("points");
            stage.whyPoints = whyNot(b, Stage::Points);
            BodyReport placed;
            samples = placePoints(*now_->world, static_cast<int>(b), *now_->optics[b],
                                  options_.limits, reporter_, placed, stage.placedOn);
            write(b, Stage::Points, placed,
                  [&](CacheWriter& writer) { addSamples(writer, stage.inputs, *samples); });
            if (!folder_) stage.samples = std::make_shared<const SurfaceSamples>(*samples);
        }
    }
    if (stage.placedOn != nullptr)
        samples = carrySamples(std::move(*samples), *stage.placedOn, body.mesh);
    describePoints(body, *now_->optics[b], samples->size(), stage.report);
    return std::move(*samples);
}

void StageChain::bringShape(std::size_t b) {
    BodyStage& stage = *stages_[b];
    if (!stage.hasShape && !takeShape(b)) makeShape(b);
    now_->optics[b]->lookThroughIf(stage.report.unscatteredShare,
                                   now_->world->scene().quality.tolerance);
}

bool StageChain::takeShape(std::size_t b) {
    if (!folder_) return false;
    const auto timer = stats_.seconds("cache");
    BodyStage& stage = *stages_[b];
    auto file = folder_->open(Stage::Correction, stage.shape, reporter_);
    if (!file) return false;
    stage.report.unscatteredShare =
        reportOf(metadataOf(*file), file->path().string()).unscatteredShare;
    stage.shapeFile = std::make_shared<CacheFile>(std::move(*file));
    stage.view.solved = solvedOf(*stage.shapeFile, 0, stage.view.cloud.points.size());
    stage.hasShape = true;
    return true;
}

void StageChain::makeShape(std::size_t b) {
    BodyStage& stage = *stages_[b];
    requireMayMake(b, Stage::Correction);
    StageFolder::Lock lock;
    if (folder_) {
        lock = folder_->lock(Stage::Correction, stage.shape, [] {});
        if (takeShape(b)) return;
    }
    stage.whyShape = whyNot(b, Stage::Correction);
    const auto entered = beams(b);
    // What scatters once is gathered from the samples.
    if (!stage.lit && now_->optics[b]->material.singleScattering)
        stage.lit = std::make_shared<const SurfaceSamples>(points(b));
    {
        const auto timer = stats_.seconds("shape");
        stage.solved = std::make_shared<const std::vector<SolvedExitance>>(shapeSolution(
            lightSpace(), static_cast<int>(b), stage.lit ? *stage.lit : SurfaceSamples{}, *entered,
            now_->optics, stage.view, reporter_, stage.report));
    }
    stage.view.solved = *stage.solved;
    stage.hasShape = true;
    write(b, Stage::Correction, stage.report,
          [&](CacheWriter& writer) { addSolved(writer, 0, stage.inputs, *stage.solved); });
}

// They come with the irradiance. Where that was made for a profile, light is followed once more.
std::shared_ptr<const EnteredBeams> StageChain::beams(std::size_t b) {
    BodyStage& stage = *stages_[b];
    if (stage.beams) return stage.beams;
    const auto find = [&] {
        if (!folder_) return false;
        const auto timer = stats_.seconds("cache");
        const auto file = folder_->open(Stage::Beams, stage.light, reporter_);
        if (file)
            stage.beams = std::make_shared<const EnteredBeams>(
                beamsOf(*file, stage.view.cloud.points.size()));
        return stage.beams != nullptr;
    };
    if (find()) return stage.beams;
    StageFolder::Lock lock;
    if (folder_) {
        lock = folder_->lock(Stage::Beams, stage.light, [] {});
        if (find()) return stage.beams;
    }
    stage.whyLight = "no beams were kept with it";
    stage.lit = std::make_shared<const SurfaceSamples>(points(b));
    stage.beams =
        std::make_shared<const EnteredBeams>(beamsInOrder(*stage.lit, light(b, *stage.lit).beams));
    write(b, Stage::Beams, stage.report,
          [&](CacheWriter& writer) { addBeams(writer, stage.inputs, *stage.beams); });
    return stage.beams;
}

void StageChain::write(std::size_t b, Stage kind, const BodyReport& report,
                       const std::function<void(CacheWriter&)>& fill) {
    if (!folder_) return;
    const auto timer = stats_.seconds("write");
    const BodyStage& stage = *stages_[b];
    try {
        CacheWriter writer(folder_->file(kind, stage.madeFrom(kind)));
        fill(writer);
        addMetadata(writer, describeBody(*now_->world, static_cast<int>(b), report, stage.inputs));
        writer.commit();
    } catch (const Error& error) {
        if (options_.mustKeep) throw;
        reporter_.warn("cache", fmt::format("{} not kept: {}", stageName(kind), error.what()));
    }
}

std::string StageChain::whyNot(std::size_t b, Stage kind) const {
    const BodyInputs& inputs = stages_[b]->inputs;
    const std::string& name = now_->world->bodies()[b].name;
    std::error_code ignored;
    if (folder_ &&
        std::filesystem::exists(folder_->file(kind, stages_[b]->madeFrom(kind)), ignored))
        return "its file there cannot be used";
    if (b < before_.size()) {
        const std::string text = differences(inputs, before_[b]->inputs, keysOf(kind));
        if (!text.empty()) return text;
    }
    if (!folder_) return before_.empty() ? "it is the first frame" : "no frame before needed it";
    if (!options_.explain && !options_.only) return "the cache has none that fits";
    std::string best;
    std::vector<std::filesystem::path> files = folder_->all(kind);
    files.resize(std::min(files.size(), kFilesExplained));
    for (const std::filesystem::path& path : files) {
        try {
            const JsonValue meta = metadataOf(CacheFile::open(path));
            const JsonValue& called = metaMember(meta, "name", path.string());
            if (!called.isString() || called.asString() != name) continue;
            const std::string text =
                differences(inputs, storedInputs(meta, inputs, path.string()), keysOf(kind));
            if (!text.empty() && (best.empty() || text.size() < best.size())) best = text;
        } catch (const Error&) {
            // Damaged, or just deleted by somebody: it explains nothing.
        }
    }
    return best.empty() ? "the cache has none of it" : best;
}

}  // namespace sss
