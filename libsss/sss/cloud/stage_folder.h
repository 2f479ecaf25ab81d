#pragma once
#include "sss/base/hash.h"
#include "sss/base/reporter.h"
#include "sss/cloud/cache_file.h"

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace sss {

enum class Stage { Points, Irradiance, Exitance, Beams, Correction };
std::string_view stageName(Stage stage);

/// A cache that is a folder: one file for each stage of each body, named by what the stage is and
/// by the fingerprint of all that it was made from ("points-HASH.ssp", "irradiance-HASH.ssi",
/// "exitance-HASH.sse", and for diffusion on the shape "beams-HASH.ssb" and "shape-HASH.ssd"). What
/// has that name is what is wanted, so that frames, scenes, processes and machines share it;
/// nothing in it goes stale, and any file may be deleted at any time. Files come whole (AtomicFile)
/// or not at all.
class StageFolder {
public:
    /// `create`: makes the folder if it is not there, and clears what killed processes left in it
    /// half written (removeAbandonedFiles()). Throws Error{Io}.
    StageFolder(std::filesystem::path folder, bool create);

    const std::filesystem::path& path() const { return folder_; }
    std::filesystem::path file(Stage stage, const Fingerprint& made) const;
    /// The stage's file; none if it is not there, or if it is damaged, which is said in a warning.
    /// What a file of more than `wholeBytes` holds is not checked yet.
    std::optional<CacheFile> open(
        Stage stage, const Fingerprint& made, Reporter& reporter,
        std::uint64_t wholeBytes = std::numeric_limits<std::uint64_t>::max()) const;
    /// The files of a stage, the newest first.
    std::vector<std::filesystem::path> all(Stage stage) const;

    /// Holds a stage while it is made, so that no other process makes it meanwhile; ends with the
    /// process, however that ends (open file description locks on one byte of "lock", by the
    /// fingerprint). Where a file system cannot lock, work may be done twice, and nothing else.
    class Lock {
    public:
        Lock() = default;
        Lock(Lock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
        Lock& operator=(Lock&& other) noexcept {
            std::swap(descriptor_, other.descriptor_);
            return *this;
        }
        ~Lock();

    private:
        friend class StageFolder;
        int descriptor_ = -1;
    };
    /// Waits for others; calls `onWait` once before it does.
    Lock lock(Stage stage, const Fingerprint& made, const std::function<void()>& onWait) const;

private:
    std::filesystem::path folder_;
};

}  // namespace sss
