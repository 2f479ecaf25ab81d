#include "fuzz/repair.h"

#include "sss/cloud/cache_format.h"

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
    header.fileBytes = fixed.size();
    if (header.tableOffset > fixed.size()) return bytes;
    header.sectionCount = (fixed.size() - header.tableOffset) / sizeof(CacheEntry);
    for (std::uint64_t i = 0; i < header.sectionCount; ++i) {
        std::byte* const place = fixed.data() + header.tableOffset + i * sizeof(CacheEntry);
        CacheEntry entry;
        std::memcpy(&entry, place, sizeof entry);
        if (entry.offset > header.tableOffset || entry.bytes > header.tableOffset - entry.offset)
            continue;
        entry.checksum = checksum(std::span(fixed).subspan(entry.offset, entry.bytes));
        std::memcpy(place, &entry, sizeof entry);
    }
    header.checksum = cacheHeaderChecksum(header, std::span(fixed).subspan(header.tableOffset));
    std::memcpy(fixed.data(), &header, sizeof header);
    return fixed;
}

}  // namespace sss::stress
