#include "fuzz/repair.h"

#include "sss/cloud/cache_format.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace sss::stress {

std::span<const std::byte> withRightChecksums(std::span<const std::byte> bytes) {
    static std::vector<std::byte> fixed;
    CacheHeader header;
    if (bytes.size() < sizeof header) return bytes;
    fixed.assign(bytes.begin(), bytes.end());
    std::memcpy(&header, fixed.data(), sizeof header);
    header.magic = kCacheMagic;
    header.endianMark = kCacheEndianMark;
    header.version = kCacheVersion;
    header.headerBytes = header.entryBytes = 64;
    header.reserved = 0;
    const std::uint64_t begin = header.tableOffset;
    if (begin > fixed.size()) return bytes;
    header.sectionCount =
        std::min<std::uint64_t>(header.sectionCount, (fixed.size() - begin) / sizeof(CacheEntry));
    std::vector<std::uint64_t> checksums;
    for (std::uint64_t i = 0; i < header.sectionCount; ++i) {
        std::byte* const place = fixed.data() + begin + i * sizeof(CacheEntry);
        CacheEntry entry;
        std::memcpy(&entry, place, sizeof entry);
        entry.firstPart = checksums.size();
        std::memcpy(place, &entry, sizeof entry);
        if (entry.offset > begin || entry.bytes > begin - entry.offset || entry.elementBytes == 0)
            continue;
        const std::uint64_t part = std::uint64_t{entry.elementBytes}
                                   << cachePartShift(entry.elementBytes);
        for (std::uint64_t at = 0; at < entry.bytes; at += part)
            checksums.push_back(checksum(
                std::span(fixed).subspan(entry.offset + at, std::min(part, entry.bytes - at))));
    }
    fixed.resize(begin + header.sectionCount * sizeof(CacheEntry));
    const auto sums = std::as_bytes(std::span(checksums));
    fixed.insert(fixed.end(), sums.begin(), sums.end());
    header.fileBytes = fixed.size();
    header.checksum = cacheHeaderChecksum(header, std::span(fixed).subspan(begin));
    std::memcpy(fixed.data(), &header, sizeof header);
    return fixed;
}

}  // namespace sss::stress
