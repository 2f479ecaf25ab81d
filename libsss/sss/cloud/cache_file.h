#pragma once
#include "sss/base/hash.h"
#include "sss/cloud/cache_writer.h"
#include "sss/cloud/mapped_file.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

// What pass 1 leaves for pass 2: a container of typed arrays ("sections"), one file for all bodies
// of a scene. A section is named by its kind and the index of its body, and carries the fingerprint
// of exactly the inputs it was made from, so that each stage can be reused on its own.
namespace sss {

struct SectionInfo {
    std::string kind;  ///< at most 8 printable ASCII characters
    std::uint32_t body = 0;
    std::uint32_t elementBytes = 0;  ///< 1 for text
    std::uint64_t count = 0;         ///< elements
    std::uint64_t offset = 0;        ///< in the file; a multiple of 64
    std::uint64_t bytes = 0;
    std::uint64_t checksum = 0;
    Fingerprint fingerprint;
};

/// A cache file, mapped and verified: after open() every section is in bounds, aligned to 64 bytes
/// and has passed its checksum. Sections of kinds unknown to the program are no error: nobody asks
/// for them. Immutable; any number of threads may read.
class CacheFile {
public:
    /// O(file size), at memory speed. Throws Error{Io} if the file cannot be read, Error{BadInput}
    /// with what exactly is wrong if it is not a whole cache of this format.
    static CacheFile open(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    std::uint64_t fileBytes() const { return file_.bytes().size(); }
    /// In the order they were written.
    std::span<const SectionInfo> sections() const { return sections_; }
    /// nullptr if there is none.
    const SectionInfo* find(std::string_view kind, std::uint32_t body) const;

    /// The elements of a section, valid while this object lives. Throws Error{BadInput} if it is
    /// missing or its elements are not of T's size.
    template <typename T>
    std::span<const T> section(std::string_view kind, std::uint32_t body) const {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kCacheAlignment);
        const auto bytes = sectionBytes(kind, body, sizeof(T));
        return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
    }
    std::string_view text(std::string_view kind, std::uint32_t body) const;

private:
    CacheFile(std::filesystem::path path, MappedFile file);
    std::span<const std::byte> sectionBytes(std::string_view kind, std::uint32_t body,
                                            std::size_t elementBytes) const;

    std::filesystem::path path_;
    MappedFile file_;
    std::vector<SectionInfo> sections_;
};

}  // namespace sss
