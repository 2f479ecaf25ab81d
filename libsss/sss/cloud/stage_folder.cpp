#include "sss/cloud/stage_folder.h"

#include "sss/base/abandoned_files.h"
#include "sss/base/error.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace sss {
namespace {

struct StageNames {
    std::string_view name, extension;
};
constexpr std::array<StageNames, 5> kStages{{{"points", ".ssp"},
                                             {"irradiance", ".ssi"},
                                             {"exitance", ".sse"},
                                             {"beams", ".ssb"},
                                             {"shape", ".ssd"}}};

const StageNames& namesOf(Stage stage) { return kStages[static_cast<std::size_t>(stage)]; }

}  // namespace

std::string_view stageName(Stage stage) { return namesOf(stage).name; }

StageFolder::StageFolder(std::filesystem::path folder, bool create) : folder_(std::move(folder)) {
    std::error_code code;
    if (create) std::filesystem::create_directories(folder_, code);
    if (!std::filesystem::is_directory(folder_))
        throw Error(ErrorKind::Io, folder_.string(),
                    create ? fmt::format("cannot make the folder: {}", code.message())
                           : "there is no such folder",
                    create ? "check that the place is writable" : "run sss-preprocess first");
    if (create) removeAbandonedFiles(folder_);
}

std::filesystem::path StageFolder::file(Stage stage, const Fingerprint& made) const {
    return folder_ /
           fmt::format("{}-{}{}", namesOf(stage).name, made.hex(), namesOf(stage).extension);
}

std::optional<CacheFile> StageFolder::open(Stage stage, const Fingerprint& made, Reporter& reporter,
                                           std::uint64_t wholeBytes) const {
    const std::filesystem::path path = file(stage, made);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return {};
    try {
        CacheFile file = CacheFile::open(path);
        if (file.fileBytes() <= wholeBytes) file.checkAll();
        return file;
    } catch (const Error& error) {
        reporter.warn("cache", fmt::format("a stage cannot be used: {}", error.what()));
        return {};
    }
}

std::vector<std::filesystem::path> StageFolder::all(Stage stage) const {
    using Dated = std::pair<std::filesystem::file_time_type, std::filesystem::path>;
    std::vector<Dated> found;
    std::error_code code;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, code)) {
        if (entry.path().extension() != namesOf(stage).extension) continue;
        std::error_code vanished;
        const auto time = entry.last_write_time(vanished);
        if (!vanished) found.emplace_back(time, entry.path());
    }
    std::ranges::sort(found, std::greater<>());
    std::vector<std::filesystem::path> paths;
    for (Dated& item : found) paths.push_back(std::move(item.second));
    return paths;
}

StageFolder::Lock::~Lock() {
    if (descriptor_ >= 0) close(descriptor_);  // which releases it
}

StageFolder::Lock StageFolder::lock(Stage stage, const Fingerprint& made,
                                    const std::function<void()>& onWait) const {
    Lock held;
    const std::filesystem::path path = folder_ / "lock";
    held.descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (held.descriptor_ < 0) return held;  // a folder that can only be read
    struct flock place {};
    place.l_type = F_WRLCK;
    place.l_whence = SEEK_SET;
    place.l_start = static_cast<off_t>((made.lo ^ static_cast<std::uint64_t>(stage)) >> 2);
    place.l_len = 1;
    if (fcntl(held.descriptor_, F_OFD_SETLK, &place) == 0) return held;
    if (errno != EAGAIN && errno != EACCES) return held;
    onWait();
    while (fcntl(held.descriptor_, F_OFD_SETLKW, &place) != 0 && errno == EINTR) {
    }
    return held;
}

}  // namespace sss
