#include "sss/base/atomic_file.h"

#include "sss/base/abandoned_files.h"
#include "sss/base/error.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <utility>

namespace sss {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* verb, int code) {
    throw Error(ErrorKind::Io, path.string(),
                fmt::format("cannot {}: {}", verb, std::strerror(code)),
                "check that the folder exists, is writable and has room");
}

std::filesystem::path checkedTarget(std::filesystem::path target) {
    std::error_code ignored;
    if (std::filesystem::is_symlink(target, ignored))
        target = std::filesystem::weakly_canonical(target, ignored);
    const auto status = std::filesystem::status(target, ignored);
    if (std::filesystem::is_directory(status)) fail(target, "write", EISDIR);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw Error(ErrorKind::Io, target.string(), "cannot write: not a regular file",
                    "a device or pipe cannot be replaced in one step; name a file");
    return target;
}

}  // namespace

// One temporary that a signal handler must be able to find without locks or allocation. Records are
// pushed to a list once, never freed, and used again by later files.
struct AtomicFile::Registration {
    enum State : int { Free, Changing, Active };

    std::atomic<int> state{Changing};
    std::array<char, PATH_MAX> path{};
    Registration* next = nullptr;

    static Registration* claim(const char* temporary);
    static std::atomic<Registration*> list;
};

std::atomic<AtomicFile::Registration*> AtomicFile::Registration::list{nullptr};

AtomicFile::Registration* AtomicFile::Registration::claim(const char* temporary) {
    Registration* record = list.load();
    for (; record; record = record->next) {
        int expected = Free;
        if (record->state.compare_exchange_strong(expected, Changing)) break;
    }
    const bool isNew = !record;
    if (isNew) record = new Registration;
    std::strncpy(record->path.data(), temporary, record->path.size() - 1);
    record->state = Active;
    if (isNew) {
        record->next = list.load();
        while (!list.compare_exchange_weak(record->next, record)) {
        }
    }
    return record;
}

AtomicFile::AtomicFile(std::filesystem::path target) : target_(checkedTarget(std::move(target))) {
    static std::atomic<unsigned> serial{0};
    // A name in use is somebody else's (a dead process with our number, or one on another machine).
    constexpr int kAttempts = 100;
    int code = EEXIST;
    for (int i = 0; i < kAttempts && descriptor_ < 0 && code == EEXIST; ++i) {
        temporary_ = target_;
        temporary_ += fmt::format(".tmp-{}-{}", getpid(), serial++);
        // Before the file exists, so that no signal can come between.
        registration_ = Registration::claim(temporary_.c_str());
        descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        code = errno;
        if (descriptor_ >= 0 && !holdTemporary(descriptor_)) {
            close(descriptor_);
            descriptor_ = -1;
            code = EEXIST;
        }
        if (descriptor_ < 0) forgetTemporary();
    }
    if (descriptor_ < 0) fail(target_, "write", code);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
    forgetTemporary();
}

void AtomicFile::forgetTemporary() noexcept {
    if (registration_) registration_->state = Registration::Free;
    registration_ = nullptr;
    temporary_.clear();
}

void AtomicFile::append(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(target_, "write", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void AtomicFile::append(std::string_view text) {
    append(std::as_bytes(std::span(text.data(), text.size())));
}

void AtomicFile::overwrite(std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written =
            pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(target_, "write", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
        offset += static_cast<std::uint64_t>(written);
    }
}

void AtomicFile::commit() {
    if (fsync(descriptor_) != 0) fail(target_, "flush", errno);
    // Held until it has its name: a network's file system says at the first close what went wrong.
    const int held = std::exchange(descriptor_, fcntl(descriptor_, F_DUPFD_CLOEXEC, 0));
    if (close(held) != 0) fail(target_, "flush", errno);
    if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(target_, "rename into place", errno);
    if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
    forgetTemporary();
}

void requireWritable(const std::filesystem::path& target) { const AtomicFile probe(target); }

void removeTemporaryFiles() noexcept {
    for (const auto* record = AtomicFile::Registration::list.load(); record; record = record->next)
        if (record->state == AtomicFile::Registration::Active) unlink(record->path.data());
}

}  // namespace sss
