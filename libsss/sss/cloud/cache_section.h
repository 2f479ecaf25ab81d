#pragma once
#include "sss/base/hash.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sss {

struct SectionInfo {
    std::string kind;  ///< at most 8 printable ASCII characters
    std::uint32_t body = 0;
    std::uint32_t elementBytes = 0;  ///< 1 for text
    std::uint64_t count = 0;         ///< elements
    std::uint64_t offset = 0;        ///< in the file; a multiple of 64
    std::uint64_t bytes = 0;
    std::uint64_t firstPart = 0;  ///< of the file's parts
    Fingerprint fingerprint;
};

/// The bytes of a section as they lie in a file, with the checksums of its parts. Valid while the
/// file is open.
class SectionParts {
public:
    SectionParts(std::string file, const SectionInfo& info, std::span<const std::byte> bytes,
                 std::span<const std::uint64_t> checksums);

    std::span<const std::byte> bytes() const { return bytes_; }
    std::uint32_t body() const { return body_; }
    /// A part is 2^shift() elements; the last one may be shorter.
    unsigned shift() const { return shift_; }
    std::size_t count() const { return checksums_.size(); }
    std::span<const std::byte> part(std::size_t index) const;
    /// Throws Error{BadInput} that names file and section if a part is not what was written.
    void check(std::size_t index) const;
    void checkAll() const;
    /// Throws Error{BadInput}: what is wrong with the file.
    [[noreturn]] void refuse(const std::string& what) const;

private:
    std::string file_, kind_;
    std::uint32_t body_;
    unsigned shift_;
    std::size_t partBytes_;
    std::span<const std::byte> bytes_;
    std::span<const std::uint64_t> checksums_;
};

/// The elements of a section that nobody has checked yet.
template <typename T>
struct UncheckedSection {
    std::span<const T> elements;
    SectionParts parts;

    std::span<const T> part(std::size_t index) const {
        const std::size_t first = index << parts.shift();
        return elements.subspan(first, parts.part(index).size() / sizeof(T));
    }
};

}  // namespace sss
