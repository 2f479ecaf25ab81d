#pragma once
#include <cstddef>
#include <filesystem>
#include <span>

namespace sss {

/// A whole file, mapped read-only. Of what is not in memory yet the system reads the pages that are
/// touched and no more (readSoon() tells it of others). What was mapped stays readable when another
/// process renames a new file over the name.
class MappedFile {
public:
    /// Throws Error{Io} if `path` cannot be opened or is no regular file. An empty file maps to an
    /// empty span.
    explicit MappedFile(const std::filesystem::path& path);
    ~MappedFile();
    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&& other) noexcept;
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    /// Page-aligned.
    std::span<const std::byte> bytes() const { return bytes_; }

private:
    std::span<const std::byte> bytes_;
};

/// Has the system read these bytes of a mapped file at once and in one go.
void readSoon(std::span<const std::byte> bytes);

}  // namespace sss
