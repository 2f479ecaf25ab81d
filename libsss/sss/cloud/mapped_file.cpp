#include "sss/cloud/mapped_file.h"

#include "sss/base/error.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

namespace sss {
namespace {

struct Descriptor {
    int number;
    ~Descriptor() {
        if (number >= 0) close(number);
    }
};

[[noreturn]] void fail(const std::filesystem::path& path, int code) {
    throw Error(ErrorKind::Io, path.string(), fmt::format("cannot read: {}", std::strerror(code)),
                "check the name and its permissions");
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
    // O_NONBLOCK: opening a pipe that nobody writes to must not wait for ever.
    const Descriptor file{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.number < 0) fail(path, errno);
    struct stat status {};
    if (fstat(file.number, &status) != 0) fail(path, errno);
    if (S_ISDIR(status.st_mode)) fail(path, EISDIR);
    if (!S_ISREG(status.st_mode))
        throw Error(ErrorKind::Io, path.string(), "cannot read: not a regular file",
                    "it has to be mapped into memory; copy it to a file first");
    if (status.st_size == 0) return;
    const auto size = static_cast<std::size_t>(status.st_size);
    void* data = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number, 0);
    if (data == MAP_FAILED) fail(path, errno);
    bytes_ = {static_cast<const std::byte*>(data), size};
    madvise(data, size, MADV_RANDOM);  // else a page brings up to a megabyte around it
}

MappedFile::~MappedFile() {
    if (!bytes_.empty()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
}

void readSoon(std::span<const std::byte> bytes) {
    if (bytes.empty()) return;
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto begin = reinterpret_cast<std::uintptr_t>(bytes.data());
    const std::uintptr_t before = begin % page;
    // Only a hint: where it cannot be taken, pages are read as they are touched.
    madvise(reinterpret_cast<void*>(begin - before), bytes.size() + before, MADV_WILLNEED);
}

}  // namespace sss
