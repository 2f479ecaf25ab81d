#pragma once
#include "sss/cloud/cache_section.h"
#include "sss/cloud/cache_writer.h"
#include "sss/cloud/mapped_file.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

// What pass 1 leaves for pass 2: a container of typed arrays ("sections"), one file for all bodies
// of a scene. A section is named by its kind and the index of its body, and carries the fingerprint
// of exactly the inputs it was made from, so that each stage can be reused on its own.
namespace sss {

/// A cache file, mapped: after open() every section is in bounds and aligned to 64 bytes, and the
/// file is as long as it should be. What a section holds is checked when it is asked for. Sections
/// of kinds unknown to the program are no error: nobody asks for them. Immutable; any number of
/// threads may read.
class CacheFile {
public:
    /// Reads header and table only: 8 bytes for each 64 KiB of the file. Throws Error{Io} if the
    /// file cannot be read, Error{BadInput} with what exactly is wrong if it is not a whole cache
    /// of this format.
    static CacheFile open(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    std::uint64_t fileBytes() const { return file_.bytes().size(); }
    /// In the order they were written.
    std::span<const SectionInfo> sections() const { return sections_; }
    /// Reads the whole file, at memory speed. Throws Error{BadInput} if any section is damaged.
    void checkAll() const;
    /// nullptr if there is none.
    const SectionInfo* find(std::string_view kind, std::uint32_t body) const;

    /// The elements of a section, valid while this object lives. Throws Error{BadInput} if it is
    /// missing, its elements are not of T's size, or it is damaged.
    template <typename T>
    std::span<const T> section(std::string_view kind, std::uint32_t body) const {
        const UncheckedSection<T> found = unchecked<T>(kind, body);
        found.parts.checkAll();
        return found.elements;
    }
    /// The same for those who check what they need of it.
    template <typename T>
    UncheckedSection<T> unchecked(std::string_view kind, std::uint32_t body) const {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kCacheAlignment);
        SectionParts parts = partsOf(kind, body, sizeof(T));
        const auto bytes = parts.bytes();
        return {{reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)},
                std::move(parts)};
    }
    std::string_view text(std::string_view kind, std::uint32_t body) const;

private:
    CacheFile(std::filesystem::path path, MappedFile file);
    SectionParts partsOf(const SectionInfo& info) const;
    SectionParts partsOf(std::string_view kind, std::uint32_t body, std::size_t elementBytes) const;

    std::filesystem::path path_;
    MappedFile file_;
    std::vector<SectionInfo> sections_;
    std::span<const std::uint64_t> checksums_;  // of all parts
};

}  // namespace sss
