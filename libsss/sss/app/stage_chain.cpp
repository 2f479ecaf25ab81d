#include "sss/app/stage_chain.h"

#include "sss/app/body_stats.h"
#include "sss/base/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>

namespace sss {
namespace {

// Of how many files --explain looks for the one that differs least.
constexpr std::size_t kFilesExplained = 16;

std::vector<std::string_view> keysOf(Stage stage) {
    if (stage == Stage::Points) return {"mesh", "sampling"};
    return {};
}

/// The inputs that a cache file says it was made from, in the words of `like`.
BodyInputs storedInputs(const JsonValue& meta, const BodyInputs& like, const std::string& where) {
    BodyInputs stored = like;
    const JsonValue& hashes = metaMember(meta, "inputs", where);
    for (InputFingerprint& input : stored) {
        const JsonValue& hex = metaMember(hashes, input.key, where);
        if (!hex.isString() || hex.asString() != input.value.hex()) input.value = {};
    }
    return stored;
}

}  // namespace

bool isFolderName(const std::filesystem::path& cache) {
    return !cache.empty() && !cache.has_filename();
}

bool isStageFolder(const std::filesystem::path& cache) {
    std::error_code ignored;
    return isFolderName(cache) || std::filesystem::is_directory(cache, ignored);
}

struct StageChain::Generation {
    std::shared_ptr<const World> world;
    std::vector<std::unique_ptr<BodyOptics>> optics;
    const World* reference = nullptr;
};

struct StageChain::BodyStage {
    BodyInputs inputs;
    Fingerprint points, light, exitance;
    const TriangleMesh* placedOn = nullptr;         // of the reference frame, if points are carried
    std::shared_ptr<const SurfaceSamples> samples;  // as placed, where there is no folder
    std::shared_ptr<const CacheFile> file;          // what the view looks into, or `made`
    std::shared_ptr<const BodyCloud> made;
    BodyCloud::View view;
    BodyReport report;
    bool isMade = false;
};

StageChain::StageChain(ChainOptions options, Reporter& reporter, RunStats& stats)
    : options_(std::move(options)), reporter_(reporter), stats_(stats) {
    if (!options_.folder.empty()) folder_.emplace(options_.folder, !options_.only);
}

StageChain::~StageChain() = default;

// The body whose points are placed in the shape of the reference frame: same faces, moved.
static const TriangleMesh* placedOn(const World* reference, const Body& body, std::size_t index) {
    if (reference == nullptr || index >= reference->bodies().size()) return nullptr;
    const Body& other = reference->bodies()[index];
    const TriangleMesh& mesh = other.mesh;
    if (other.name != body.name || mesh.faces != body.mesh.faces ||
        mesh.positions == body.mesh.positions)
        return nullptr;
    return &mesh;
}

void StageChain::begin(std::shared_ptr<const World> world, const World* reference) {
    now_ = std::make_shared<Generation>();
    now_->world = std::move(world);
    now_->optics = makeBodyOptics(*now_->world);
    now_->reference = reference;
    light_.reset();
    rows_.clear();
    before_ = std::move(stages_);
    stages_.clear();
    for (std::size_t b = 0; b < now_->optics.size(); ++b) {
        const Body& body = now_->world->bodies()[b];
        auto stage = std::make_unique<BodyStage>();
        stage->placedOn = placedOn(reference, body, b);
        stage->inputs =
            bodyInputs(*now_->world, static_cast<int>(b),
                       pointSpacingMm(*now_->world, body, *now_->optics[b]), stage->placedOn);
        stage->points = pointsFingerprint(stage->inputs);
        stage->light = lightFingerprint(stage->inputs);
        stage->exitance = exitanceFingerprint(*now_->world, static_cast<int>(b), stage->inputs);
        stages_.push_back(std::move(stage));
    }
}

void StageChain::prepare(std::shared_ptr<const World> world, const World* reference) {
    begin(std::move(world), reference);
    for (std::size_t b = 0; b < stages_.size(); ++b) findOrMake(b);
    std::vector<BodyReport> reports;
    const auto made = std::make_unique<bool[]>(stages_.size());
    for (std::size_t b = 0; b < stages_.size(); ++b) {
        reports.push_back(stages_[b]->report);
        made[b] = stages_[b]->isMade;
    }
    recordBodies(reports, {made.get(), stages_.size()}, now_->optics, stats_);
    light_.reset();
}

void StageChain::open(const std::filesystem::path& file, std::shared_ptr<const World> world,
                      const World* reference) {
    begin(std::move(world), reference);
    std::vector<BodyInputs> inputs;
    for (const auto& stage : stages_) inputs.push_back(stage->inputs);
    file_ = std::make_shared<const CloudCache>(file, *now_->world, inputs);
    for (std::size_t b = 0; b < stages_.size(); ++b) {
        stages_[b]->view = file_->view(b);
        stages_[b]->report = file_->report(b);
        for (const char* name : {"points", "irradiance", "octree"}) addRow(b, name, true);
    }
}

void StageChain::reuse() {
    rows_.clear();
    for (std::size_t b = 0; b < stages_.size(); ++b)
        for (const char* name : {"points", "irradiance", "octree"}) addRow(b, name, true);
}

void StageChain::findOrMake(std::size_t b) {
    BodyStage& stage = *stages_[b];
    if (b < before_.size() && before_[b]->light == stage.light) {
        const BodyStage& held = *before_[b];
        stage.file = held.file;
        stage.made = held.made;
        stage.view = held.view;
        stage.report = held.report;
        stage.samples = held.samples;
    } else if (!takeFromFolder(b)) {
        make(b);
        return;
    }
    for (const char* name : {"points", "irradiance", "octree"}) addRow(b, name, true);
}

bool StageChain::takeFromFolder(std::size_t b) {
    if (!folder_) return false;
    const auto timer = stats_.seconds("cache");
    BodyStage& stage = *stages_[b];
    auto file = folder_->open(Stage::Irradiance, stage.light, reporter_);
    if (!file) return false;
    const std::string where = file->path().string();
    stage.report = reportOf(metadataOf(*file), where);
    stage.file = std::make_shared<CacheFile>(std::move(*file));
    stage.view = cloudOf(*stage.file, 0, stage.report.spacingMm);
    return true;
}

void StageChain::make(std::size_t b) {
    BodyStage& stage = *stages_[b];
    const std::string& name = now_->world->bodies()[b].name;
    if (options_.only)
        throw Error(ErrorKind::BadInput, options_.folder.string(),
                    fmt::format("has no irradiance for \"{}\" in frame {}: {}", name,
                                now_->world->scene().frame, whyNot(b, Stage::Irradiance)),
                    "run sss-preprocess on this scene and frame, or leave out --cache-only");
    StageFolder::Lock lock;
    if (folder_) {
        lock = folder_->lock(Stage::Irradiance, stage.light, [&] {
            reporter_.info("cache", fmt::format("{}: another process is at it, waiting", name));
        });
        if (takeFromFolder(b)) {
            for (const char* row : {"points", "irradiance", "octree"}) addRow(b, row, true);
            return;
        }
    }
    SurfaceSamples samples = points(b);
    std::vector<Rgb> irradiance;
    {
        const auto timer = stats_.seconds("irradiance");
        if (!light_) light_ = now_->world->inLightSpace();
        irradiance = lightPoints(*light_, static_cast<int>(b), samples, now_->optics, reporter_,
                                 stage.report);
    }
    addRow(b, "irradiance", false);
    {
        const auto timer = stats_.seconds("octree");
        stage.made = std::make_shared<const BodyCloud>(
            buildCloud(std::move(samples), std::move(irradiance), stage.report));
    }
    addRow(b, "octree", false);
    stage.view = stage.made->view();
    stage.isMade = true;
    write(Stage::Irradiance, stage.light, [&](CacheWriter& writer) {
        addCloud(writer, 0, stage.inputs, stage.view);
        addMetadata(writer,
                    describeBody(*now_->world, static_cast<int>(b), stage.report, stage.inputs));
    });
}

SurfaceSamples StageChain::points(std::size_t b) {
    BodyStage& stage = *stages_[b];
    const Body& body = now_->world->bodies()[b];
    const TriangleMesh& mesh = stage.placedOn != nullptr ? *stage.placedOn : body.mesh;
    std::optional<SurfaceSamples> samples;
    const auto find = [&] {
        if (b < before_.size() && before_[b]->points == stage.points && before_[b]->samples) {
            stage.samples = before_[b]->samples;
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
            samples = placePoints(*now_->world, static_cast<int>(b), *now_->optics[b],
                                  options_.limits, reporter_, stage.report, stage.placedOn);
            addRow(b, "points", false);
            write(Stage::Points, stage.points, [&](CacheWriter& writer) {
                addSamples(writer, stage.inputs, *samples);
                addMetadata(writer, describeBody(*now_->world, static_cast<int>(b), stage.report,
                                                 stage.inputs));
            });
            if (!folder_) stage.samples = std::make_shared<const SurfaceSamples>(*samples);
        }
    }
    if (rows_.empty() || rows_.back().stage != "points") addRow(b, "points", true);
    if (stage.placedOn != nullptr)
        samples = carrySamples(std::move(*samples), *stage.placedOn, body.mesh);
    describePoints(body, *now_->optics[b], samples->size(), stage.report);
    return std::move(*samples);
}

void StageChain::write(Stage stage, const Fingerprint& made,
                       const std::function<void(CacheWriter&)>& fill) {
    if (!folder_) return;
    const auto timer = stats_.seconds("write");
    try {
        CacheWriter writer(folder_->file(stage, made));
        fill(writer);
        writer.commit();
    } catch (const Error& error) {
        if (options_.mustKeep) throw;
        reporter_.warn("cache", fmt::format("{} not kept: {}", stageName(stage), error.what()));
    }
}

void StageChain::addRow(std::size_t b, std::string stage, bool reused) {
    std::string why;
    if (!reused)
        why = stage == "octree" ? std::string("its irradiance was made")
                                : whyNot(b, stage == "points" ? Stage::Points : Stage::Irradiance);
    rows_.push_back({now_->world->bodies()[b].name, std::move(stage), reused, std::move(why)});
}

std::string StageChain::whyNot(std::size_t b, Stage kind) const {
    const BodyInputs& inputs = stages_[b]->inputs;
    const std::string& name = now_->world->bodies()[b].name;
    if (b < before_.size()) {
        const std::string text = differences(inputs, before_[b]->inputs, keysOf(kind));
        if (!text.empty()) return text;
    }
    if (!folder_) return "it is the first frame";
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

std::span<const std::unique_ptr<BodyOptics>> StageChain::optics() const { return now_->optics; }

std::vector<CachedBody> StageChain::clouds() const {
    std::vector<CachedBody> all;
    for (const auto& stage : stages_) all.push_back({stage->view, &stage->report, &stage->inputs});
    return all;
}

std::vector<FieldInput> StageChain::fieldInputs() const {
    std::vector<FieldInput> inputs;
    for (std::size_t b = 0; b < stages_.size(); ++b) {
        const BodyStage& stage = *stages_[b];
        inputs.push_back(
            {&now_->world->bodies()[b], now_->optics[b].get(), stage.view, stage.exitance,
             std::make_shared<
                 std::tuple<std::shared_ptr<Generation>, std::shared_ptr<const CacheFile>,
                            std::shared_ptr<const BodyCloud>, std::shared_ptr<const CloudCache>>>(
                 now_, stage.file, stage.made, file_)});
    }
    return inputs;
}

Fingerprint StageChain::fingerprint() const {
    Hasher all;
    for (const auto& stage : stages_) all.add(stage->light);
    return all.finish();
}

}  // namespace sss
