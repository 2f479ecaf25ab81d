#pragma once
#include "sss/app/run_stats.h"
#include "sss/app/stage_table.h"
#include "sss/base/stopwatch.h"
#include "sss/cloud/stage_folder.h"
#include "sss/integrate/body_field.h"
#include "sss/integrate/exitance_cache.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sss {

/// What the field of one body is made of.
struct FieldInput {
    const Body* body;
    const BodyOptics* optics;
    BodyCloud::View cloud;
    Fingerprint exitance;  ///< of all that it depends on; 0: the frame needs no field of the body
    std::shared_ptr<const void> owner;  ///< keeps all that the above refers to
};

/// The last stage: exitance fields that outlive the frame they were made for, as long as all they
/// depend on is the same, and are kept in the cache: a folder of stages, one file beside a cache
/// file, or nowhere.
class ExitanceChain {
public:
    ExitanceChain(const StageFolder* folder, Reporter& reporter, RunStats& stats);
    ~ExitanceChain();
    ExitanceChain(const ExitanceChain&) = delete;
    ExitanceChain& operator=(const ExitanceChain&) = delete;

    /// Fields for a frame, by body. `beside`: the cache file beside which exitance is kept, where
    /// there is no folder; empty: it is not.
    std::span<const std::unique_ptr<BodyField>> fields(std::vector<FieldInput> wanted,
                                                       double tolerance,
                                                       const std::filesystem::path& beside);
    /// What the frame did. Writes what is new if the last time was long ago, or `now`.
    std::vector<StageRow> finishFrame(bool now);
    /// Of all fields so far.
    ExitanceCounts counts() const;

private:
    struct Keeper;
    struct Kept {
        FieldInput input;
        std::uint64_t groups = 0;  ///< computed before this frame
        bool isNew = true;         ///< this frame's
    };
    void retire(std::size_t body);
    void keep(const std::filesystem::path& beside);
    void save();

    const StageFolder* folder_;
    Reporter& reporter_;
    RunStats& stats_;
    std::vector<Kept> kept_;                          // by body
    std::vector<std::unique_ptr<BodyField>> fields_;  // by body
    std::vector<Keeper> keepers_;
    ExitanceCounts retired_;  // of fields that are gone
    Stopwatch sinceSaved_;
};

}  // namespace sss
