#pragma once
#include "sss/app/exitance_chain.h"
#include "sss/app/run_stats.h"
#include "sss/app/stage_table.h"
#include "sss/cloud/stage_folder.h"
#include "sss/integrate/cloud_cache.h"
#include "sss/integrate/preprocess.h"

#include <memory>
#include <optional>
#include <vector>

namespace sss {

/// Whether the name of a cache ends with "/": a folder of stages, there or to be made.
bool isFolderName(const std::filesystem::path& cache);
/// ... or such a folder is there.
bool isStageFolder(const std::filesystem::path& cache);

struct ChainOptions {
    std::filesystem::path folder;  ///< a folder of stages; empty: stages live in memory
    PreprocessLimits limits;
    bool only = false;     ///< what is not in the folder is an error
    bool mustKeep = true;  ///< a stage that cannot be written is an error, not a warning
    bool explain = false;  ///< look through the folder for what changed
    /// Bodies that the camera may see by their diffuse limit (findDiffuseLimits()) need no stages.
    bool byDiffuseLimit = false;
    /// Stages in files are checked to their last byte, however large, and made anew if damaged.
    bool checkWhole = false;
};

/// Pass 1 as a chain of stages (points; irradiance with beams and octree; diffusion on the shape
/// where a body asks for it; exitance), each with the fingerprint of all that it depends on. A
/// frame takes each stage from the frame before it or from the folder if the fingerprint holds, and
/// makes the others. What it gives is the same bytes wherever the stages came from.
class StageChain {
public:
    StageChain(ChainOptions options, Reporter& reporter, RunStats& stats);
    ~StageChain();
    StageChain(const StageChain&) = delete;
    StageChain& operator=(const StageChain&) = delete;

    /// Finds or makes the clouds of all bodies. `reference`: the scene in its reference frame, for
    /// bodies that deform, or null. Throws Error{BadInput} for what --cache-only lacks.
    void prepare(std::shared_ptr<const World> world, const World* reference);
    /// The same from a single file for all bodies. Throws Error{BadInput} if it is of another
    /// scene.
    void open(const std::filesystem::path& file, std::shared_ptr<const World> world,
              const World* reference);
    /// The frame has the same world, seen by another camera: its stages hold, and bodies that were
    /// in their diffuse limit may want some.
    void reuse();

    // Of the world prepared last, by body.
    std::span<const std::unique_ptr<BodyOptics>> optics() const;
    std::vector<CachedBody> clouds() const;
    /// What the exitance fields are made of.
    std::vector<FieldInput> fieldInputs() const;
    const StageFolder* folder() const { return folder_ ? &*folder_ : nullptr; }

    /// Of this frame.
    const std::vector<StageRow>& rows() const { return rows_; }
    /// Of the clouds that lie in files, bytes that somebody has needed so far.
    std::uint64_t cacheBytesNeeded() const;
    /// Of all that the clouds were made from.
    Fingerprint fingerprint() const;

private:
    struct Generation;  // a world with its optics
    struct BodyStage;

    void begin(std::shared_ptr<const World> world, const World* reference);
    void adopt(std::size_t body);
    void findLimits();
    bool isNeeded(std::size_t body) const;
    void requireMemoryForAll() const;
    void finish();

    // In stage_maker.cpp.
    void bring(std::size_t body);
    bool takeLight(std::size_t body);
    void makeLight(std::size_t body);
    void bringShape(std::size_t body);
    bool takeShape(std::size_t body);
    void makeShape(std::size_t body);
    SurfaceSamples points(std::size_t body);
    std::shared_ptr<const EnteredBeams> beams(std::size_t body);
    IrradianceResult light(std::size_t body, const SurfaceSamples& samples);
    const World& lightSpace();
    void requireMayMake(std::size_t body, Stage stage) const;
    void write(std::size_t body, Stage stage, const BodyReport& report,
               const std::function<void(CacheWriter&)>& fill);
    std::string whyNot(std::size_t body, Stage stage) const;

    ChainOptions options_;
    Reporter& reporter_;
    RunStats& stats_;
    std::optional<StageFolder> folder_;
    std::shared_ptr<Generation> now_;
    std::vector<std::unique_ptr<BodyStage>> stages_,
        before_;                          // by body; before_: of the last world
    std::unique_ptr<const World> light_;  // made when first needed
    std::vector<StageRow> rows_;
};

}  // namespace sss
