#include "sss/base/atomic_file.h"

#include "sss/base/error.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

namespace sss {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* verb) {
    throw Error(ErrorKind::Io, path.string(), fmt::format("cannot {}: {}", verb, std::strerror(errno)),
                "check that the folder exists, is writable and has room");
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)) {
    static std::atomic<unsigned> serial{0};
    temporary_ = target_;
    temporary_ += fmt::format(".tmp-{}-{}", getpid(), serial++);
    if (std::filesystem::is_directory(target_)) {
        errno = EISDIR;
        fail(target_, "write");
    }
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(target_, "write");
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::append(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(target_, "write");
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void AtomicFile::append(std::string_view text) {
    append(std::as_bytes(std::span(text.data(), text.size())));
}

void AtomicFile::commit() {
    if (fsync(descriptor_) != 0) fail(target_, "flush");
    if (close(descriptor_) != 0) {
        descriptor_ = -1;
        fail(target_, "close");
    }
    descriptor_ = -1;
    if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(target_, "rename into place");
    temporary_.clear();
}

void requireWritable(const std::filesystem::path& target) { const AtomicFile probe(target); }

}  // namespace sss
