#pragma once
#include "sss/base/hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

// The bytes of a cache file, for cache_file.cpp and its tests. All numbers are little-endian.
//
//   CacheHeader             64 bytes at offset 0
//   section, section, ...   each at the next multiple of 64, in the order of the table; gaps are 0
//   CacheEntry[...]         the table, at the next multiple of 64
//   checksum[...]           of each part of each section, in the order of the table; the file ends
//
// Nothing may lie elsewhere: every byte is a number that is checked, part of a section with a
// checksum, or a zero. The table comes last so that sections stream to disk as they are made.
// Sections have a checksum for each part, so that what nobody asks for need not be read.
namespace sss {

static_assert(std::endian::native == std::endian::little,
              "the cache file is mapped as it stands and is little-endian");

inline constexpr std::array<unsigned char, 8> kCacheMagic{0x89, 'S',  'S',  'C',
                                                          '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint32_t kCacheEndianMark = 0x01020304;
inline constexpr std::uint32_t kCacheVersion = 5;
inline constexpr std::uint64_t kCacheAlignment = 64;

struct CacheHeader {
    std::array<unsigned char, 8> magic = kCacheMagic;
    std::uint32_t endianMark = kCacheEndianMark;
    std::uint32_t version = kCacheVersion;
    std::uint32_t headerBytes = 64;
    std::uint32_t entryBytes = 64;
    std::uint64_t sectionCount = 0;
    std::uint64_t tableOffset = 0;
    std::uint64_t fileBytes = 0;
    std::uint64_t reserved = 0;
    std::uint64_t checksum = 0;  ///< cacheHeaderChecksum()
};
static_assert(sizeof(CacheHeader) == 64);

struct CacheEntry {
    std::array<char, 8> kind{};  ///< printable ASCII without blanks, filled up with zeros
    std::uint32_t body = 0;
    std::uint32_t elementBytes = 0;
    std::uint64_t count = 0;
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;      ///< count * elementBytes
    std::uint64_t firstPart = 0;  ///< parts of the sections before it
    std::uint64_t fingerprintLo = 0, fingerprintHi = 0;
};
static_assert(sizeof(CacheEntry) == 64);

/// A part of a section is as many elements as fit in so many bytes, rounded down to a power of two
/// so that a shift tells the part of an element; at least one. The last part may be shorter.
inline constexpr std::uint64_t kCachePartBytes = std::uint64_t{1} << 16;
constexpr unsigned cachePartShift(std::uint64_t elementBytes) {
    return static_cast<unsigned>(
        std::bit_width(std::max<std::uint64_t>(kCachePartBytes / elementBytes, 1)) - 1);
}
constexpr std::uint64_t cachePartCount(std::uint64_t elements, unsigned shift) {
    return elements == 0 ? 0 : ((elements - 1) >> shift) + 1;
}

/// CacheHeader::checksum of `header` and the bytes of the table and the parts' checksums behind it:
/// XXH3-64 of both their checksums.
inline std::uint64_t cacheHeaderChecksum(CacheHeader header, std::span<const std::byte> table) {
    header.checksum = 0;
    const std::array<std::uint64_t, 2> both{checksum(std::as_bytes(std::span(&header, 1))),
                                            checksum(table)};
    return checksum(std::as_bytes(std::span(both)));
}

}  // namespace sss
