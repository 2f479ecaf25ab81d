#include "sss/app/stage_chain.h"

#include "sss/app/body_stats.h"
#include "sss/app/placed_on.h"
#include "sss/app/stage_state.h"
#include "sss/base/require_memory.h"
#include "sss/cloud/cloud_guard.h"
#include "sss/integrate/diffuse_limit.h"

#include <fmt/core.h>

#include <algorithm>

namespace sss {
namespace {

// What stages keep of a point in memory, while pass 1 is at other bodies: itself, its cell and its
// share of the octree.
constexpr std::uint64_t kBytesPerPointKept = 190;

// Far more points than a body can want, had it not been for its limit.
void warnOfScale(const World& world, const Body& body, const BodyOptics& optics,
                 const PreprocessLimits& limits, Reporter& reporter) {
    const std::size_t expected = expectedPoints(world, body, optics);
    if (expected > limits.mostPoints)
        reporter.warn("points", fmt::format("{}: would need {} points, were it not in its diffuse "
                                            "limit: check the scale of the scene (metersPerUnit)",
                                            body.name, expected));
}

}  // namespace

bool isFolderName(const std::filesystem::path& cache) {
    return !cache.empty() && !cache.has_filename();
}

bool isStageFolder(const std::filesystem::path& cache) {
    std::error_code ignored;
    return isFolderName(cache) || std::filesystem::is_directory(cache, ignored);
}

StageChain::StageChain(ChainOptions options, Reporter& reporter, RunStats& stats)
    : options_(std::move(options)), reporter_(reporter), stats_(stats) {
    if (!options_.folder.empty()) folder_.emplace(options_.folder, !options_.only);
}

StageChain::~StageChain() = default;

void StageChain::begin(std::shared_ptr<const World> world, const World* reference) {
    now_ = std::make_shared<Generation>();
    now_->world = std::move(world);
    now_->optics = makeBodyOptics(*now_->world);
    light_.reset();
    before_ = std::move(stages_);
    stages_.clear();
    for (std::size_t b = 0; b < now_->optics.size(); ++b) {
        const Body& body = now_->world->bodies()[b];
        auto stage = std::make_unique<BodyStage>();
        stage->placedOn = placedOn(reference, body, b);
        stage->inputs =
            bodyInputs(*now_->world, static_cast<int>(b), now_->optics,
                       pointSpacingMm(*now_->world, body, *now_->optics[b]), stage->placedOn);
        stage->points = pointsFingerprint(stage->inputs);
        stage->light = lightFingerprint(stage->inputs);
        stage->shape = shapeFingerprint(stage->inputs);
        stage->exitance = exitanceFingerprint(*now_->world, static_cast<int>(b), stage->inputs);
        stages_.push_back(std::move(stage));
        adopt(b);
    }
    findLimits();
}

// What the frame before has already.
void StageChain::adopt(std::size_t b) {
    if (b >= before_.size()) return;
    const BodyStage& held = *before_[b];
    BodyStage& stage = *stages_[b];
    if (held.points == stage.points) stage.samples = held.samples;
    if (held.light != stage.light) return;
    stage.beams = held.beams;
    if (!held.hasLight) return;
    stage.hasLight = true;
    stage.file = held.file;
    stage.made = held.made;
    stage.cache = held.cache;
    stage.view = held.view;
    stage.report = held.report;
    stage.report.counts = {};
    stage.report.nonFinite = 0;
    stage.hasShape = held.hasShape && held.shape == stage.shape;
    if (stage.hasShape) {
        stage.shapeFile = held.shapeFile;
        stage.solved = held.solved;
        return;
    }
    stage.view.solved = {};
    stage.report.shape.reset();
    stage.report.unscatteredShare.reset();
}

void StageChain::findLimits() {
    if (!options_.byDiffuseLimit) return;
    for (const auto& optics : now_->optics) optics->inDiffuseLimit = false;
    findDiffuseLimits(*now_->world, now_->optics, reporter_);
    for (std::size_t b = 0; b < stages_.size(); ++b)
        if (!isNeeded(b))
            warnOfScale(*now_->world, now_->world->bodies()[b], *now_->optics[b], options_.limits,
                        reporter_);
}

bool StageChain::isNeeded(std::size_t b) const { return !now_->optics[b]->inDiffuseLimit; }

// Bodies that fit one by one may not fit together. What lies in files is the system's to keep.
void StageChain::requireMemoryForAll() const {
    if (folder_) return;
    std::uint64_t points = 0, most = 0, bodies = 0;
    for (std::size_t b = 0; b < stages_.size(); ++b) {
        const BodyStage& stage = *stages_[b];
        if (!isNeeded(b) || stage.hasLight) continue;
        const Body& body = now_->world->bodies()[b];
        const std::uint64_t wanted =
            expectedPoints(*now_->world, body, *now_->optics[b], stage.placedOn);
        if (wanted > options_.limits.mostPoints) return;  // placePoints() says so of this one
        points += wanted;
        most = std::max(most, wanted);
        ++bodies;
    }
    if (bodies < 2) return;
    requireMemory(now_->world->scene().file.string(),
                  fmt::format("the {} points of its {} bodies", points, bodies),
                  most * kBytesPerPoint + (points - most) * kBytesPerPointKept,
                  "check the scale of the scene (metersPerUnit), raise the tolerance, or set "
                  "--spacing");
}

void StageChain::prepare(std::shared_ptr<const World> world, const World* reference) {
    begin(std::move(world), reference);
    requireMemoryForAll();
    for (std::size_t b = 0; b < stages_.size(); ++b)
        if (isNeeded(b)) bring(b);
    finish();
}

void StageChain::open(const std::filesystem::path& file, std::shared_ptr<const World> world,
                      const World* reference) {
    begin(std::move(world), reference);
    std::vector<BodyInputs> inputs;
    for (const auto& stage : stages_) inputs.push_back(stage->inputs);
    const auto cache = std::make_shared<const CloudCache>(file, *now_->world, now_->optics, inputs);
    for (std::size_t b = 0; b < stages_.size(); ++b) {
        BodyStage& stage = *stages_[b];
        stage.cache = cache;
        stage.view = cache->view(b);
        stage.report = cache->report(b);
        stage.hasLight = stage.hasShape = true;
    }
    finish();
}

void StageChain::reuse() {
    findLimits();
    for (std::size_t b = 0; b < stages_.size(); ++b) {
        BodyStage& stage = *stages_[b];
        stage.whyPoints = stage.whyLight = stage.whyOctree = stage.whyShape = {};
        stage.report.counts = {};
        stage.report.nonFinite = 0;
        if (isNeeded(b)) bring(b);
    }
    finish();
}

// The table of the frame, and its statistics.
void StageChain::finish() {
    light_.reset();
    rows_.clear();
    std::vector<BodyReport> reports;
    const auto made = std::make_unique<bool[]>(stages_.size());
    for (std::size_t b = 0; b < stages_.size(); ++b) {
        BodyStage& stage = *stages_[b];
        const Body& body = now_->world->bodies()[b];
        if (isNeeded(b)) {
            const auto add = [&](const char* name, const std::string& why) {
                rows_.push_back({body.name, name, why.empty(), why});
            };
            add("points", stage.whyPoints);
            add("irradiance", stage.whyLight);
            add("octree", stage.whyOctree);
            if (now_->optics[b]->onShape) add("shape", stage.whyShape);
        } else {
            stage.report.name = body.name;
            stage.report.areaMm2 = body.mesh.area();
        }
        stage.lit.reset();
        if (folder_) stage.beams.reset();
        reports.push_back(stage.report);
        made[b] = !stage.whyOctree.empty();
    }
    recordBodies(reports, {made.get(), stages_.size()}, now_->optics, stats_);
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
        using Owner = std::pair<std::shared_ptr<Generation>, BodyStage>;
        inputs.push_back({&now_->world->bodies()[b], now_->optics[b].get(), stage.view,
                          isNeeded(b) ? stage.exitance : Fingerprint{},
                          std::make_shared<const Owner>(now_, stage)});
    }
    return inputs;
}

std::uint64_t StageChain::cacheBytesNeeded() const {
    std::uint64_t bytes = 0;
    for (const auto& stage : stages_)
        if (const auto& guard = stage->view.cloud.guard) bytes += guard->bytesChecked();
    return bytes;
}

Fingerprint StageChain::fingerprint() const {
    Hasher all;
    for (const auto& stage : stages_) all.add(stage->shape);
    return all.finish();
}

}  // namespace sss
