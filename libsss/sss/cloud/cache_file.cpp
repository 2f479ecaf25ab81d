#include "sss/cloud/cache_file.h"

#include "sss/base/error.h"
#include "sss/cloud/cache_format.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace sss {
namespace {

constexpr const char* kRebuild = "run sss-preprocess again";

// Checks all of a mapped cache but what its sections hold; throws Error{BadInput} at the first
// thing that is not as CacheWriter leaves it. Nothing is allocated on the word of the file.
class TableReader {
public:
    TableReader(const std::filesystem::path& path, std::span<const std::byte> bytes)
        : path_(path), bytes_(bytes) {}

    std::vector<SectionInfo> read() {
        readHeader();
        checkLayout();
        std::vector<SectionInfo> sections;
        std::uint64_t end = sizeof(CacheHeader);
        for (std::uint64_t i = 0; i < header_.sectionCount; ++i) {
            sections.push_back(checkedSection(i, end));
            end = sections.back().offset + sections.back().bytes;
        }
        refuseDuplicates(sections);
        checkGap(end, header_.tableOffset);
        checkParts(sections);
        return sections;
    }

    std::span<const std::uint64_t> checksums() const {
        const auto bytes = bytes_.subspan(checksumOffset());
        return {reinterpret_cast<const std::uint64_t*>(bytes.data()),
                bytes.size() / sizeof(std::uint64_t)};
    }

private:
    [[noreturn]] void refuse(const std::string& what, const std::string& hint = kRebuild) const {
        throw Error(ErrorKind::BadInput, path_.string(), what, hint);
    }

    void readHeader() {
        if (bytes_.empty()) refuse("the file is empty, not a cache");
        const std::size_t seen = std::min(bytes_.size(), kCacheMagic.size());
        if (std::memcmp(bytes_.data(), kCacheMagic.data(), seen) != 0)
            refuse("not a cache file", "name the file that sss-preprocess wrote with -o");
        if (bytes_.size() < sizeof header_)
            refuse(fmt::format("truncated: a header takes {} bytes, the file has {}",
                               sizeof header_, bytes_.size()));
        std::memcpy(&header_, bytes_.data(), sizeof header_);
        if (header_.endianMark != kCacheEndianMark)
            refuse("its byte order is not little-endian, or its header is damaged");
        if (header_.version > kCacheVersion)
            refuse(fmt::format("format {} is newer than this program's {}", header_.version,
                               kCacheVersion),
                   "use the program that wrote it, or run this sss-preprocess again");
        if (header_.version < kCacheVersion)
            refuse(fmt::format("format {} is older than this program's {}", header_.version,
                               kCacheVersion));
    }

    // Everything that must hold before the table can be read; no product or sum can overflow.
    void checkLayout() const {
        if (header_.fileBytes > bytes_.size())
            refuse(fmt::format("truncated: the header says {} bytes, the file has {}",
                               header_.fileBytes, bytes_.size()));
        if (header_.fileBytes < bytes_.size())
            refuse(fmt::format("too long: the header says {} bytes, the file has {}",
                               header_.fileBytes, bytes_.size()));
        if (header_.headerBytes != sizeof(CacheHeader) ||
            header_.entryBytes != sizeof(CacheEntry) || header_.reserved != 0)
            refuse("its header is damaged (sizes)");
        if (header_.tableOffset < sizeof(CacheHeader) || header_.tableOffset > header_.fileBytes ||
            header_.tableOffset % kCacheAlignment != 0)
            refuse("its header is damaged (place of the table)");
        const std::uint64_t tableBytes = header_.fileBytes - header_.tableOffset;
        if (tableBytes % sizeof(std::uint64_t) != 0 ||
            tableBytes / sizeof(CacheEntry) < header_.sectionCount)
            refuse(fmt::format("its header is damaged ({} sections do not fit the file)",
                               header_.sectionCount));
        if (cacheHeaderChecksum(header_, bytes_.subspan(header_.tableOffset)) != header_.checksum)
            refuse("its header or table is damaged (checksum)");
    }

    // A table with a right checksum may still be wrong: a broken or hostile writer.
    SectionInfo checkedSection(std::uint64_t index, std::uint64_t previousEnd) const {
        CacheEntry entry;
        std::memcpy(&entry, bytes_.data() + header_.tableOffset + index * sizeof entry,
                    sizeof entry);
        const auto end = std::find(entry.kind.begin(), entry.kind.end(), '\0');
        const bool isNamed =
            end != entry.kind.begin() &&
            std::all_of(entry.kind.begin(), end, [](char c) { return c > ' ' && c < '\x7f'; }) &&
            std::all_of(end, entry.kind.end(), [](char c) { return c == '\0'; });
        if (!isNamed) refuse(fmt::format("section {} of its table has no valid name", index));
        SectionInfo info{std::string(entry.kind.begin(), end),
                         entry.body,
                         entry.elementBytes,
                         entry.count,
                         entry.offset,
                         entry.bytes,
                         entry.firstPart,
                         {entry.fingerprintLo, entry.fingerprintHi}};
        if (info.offset % kCacheAlignment != 0 || info.offset < previousEnd ||
            info.offset > header_.tableOffset || info.bytes > header_.tableOffset - info.offset)
            refuse(fmt::format("{} lies outside the file or over another section", name(info)));
        if (info.elementBytes == 0 || info.bytes % info.elementBytes != 0 ||
            info.bytes / info.elementBytes != info.count)
            refuse(fmt::format("{} says {} elements of {} bytes, but has {} bytes", name(info),
                               info.count, info.elementBytes, info.bytes));
        checkGap(previousEnd, info.offset);
        return info;
    }

    void refuseDuplicates(const std::vector<SectionInfo>& sections) const {
        std::vector<std::pair<std::string_view, std::uint32_t>> names;
        names.reserve(sections.size());
        for (const SectionInfo& section : sections) names.emplace_back(section.kind, section.body);
        std::sort(names.begin(), names.end());
        const auto twice = std::adjacent_find(names.begin(), names.end());
        if (twice != names.end())
            refuse(fmt::format("section '{}' of body {} stands in its table twice", twice->first,
                               twice->second));
    }

    void checkGap(std::uint64_t begin, std::uint64_t end) const {
        const auto gap = bytes_.subspan(begin, end - begin);
        const auto isZero = [](std::byte b) { return b == std::byte{0}; };
        if (gap.size() >= kCacheAlignment || !std::all_of(gap.begin(), gap.end(), isZero))
            refuse(fmt::format("damaged between sections, at byte {}", begin));
    }

    // Sections lie one behind the other in the file, so that their parts cannot overflow.
    void checkParts(const std::vector<SectionInfo>& sections) const {
        std::uint64_t parts = 0;
        for (const SectionInfo& section : sections) {
            if (section.firstPart != parts)
                refuse(fmt::format("{} has its checksums elsewhere", name(section)));
            parts += cachePartCount(section.count, cachePartShift(section.elementBytes));
        }
        if (checksums().size() != parts)
            refuse(fmt::format("it has {} checksums for {} parts", checksums().size(), parts));
    }

    std::uint64_t checksumOffset() const {
        return header_.tableOffset + header_.sectionCount * sizeof(CacheEntry);
    }

    static std::string name(const SectionInfo& section) {
        return fmt::format("section '{}' of body {}", section.kind, section.body);
    }

    const std::filesystem::path& path_;
    std::span<const std::byte> bytes_;
    CacheHeader header_;
};

}  // namespace

CacheFile::CacheFile(std::filesystem::path path, MappedFile file)
    : path_(std::move(path)), file_(std::move(file)) {}

CacheFile CacheFile::open(const std::filesystem::path& path) {
    CacheFile cache(path, MappedFile(path));
    TableReader table(path, cache.file_.bytes());
    cache.sections_ = table.read();
    cache.checksums_ = table.checksums();
    return cache;
}

void CacheFile::checkAll() const {
    for (const SectionInfo& info : sections_) partsOf(info).checkAll();
}

const SectionInfo* CacheFile::find(std::string_view kind, std::uint32_t body) const {
    const auto found = std::find_if(sections_.begin(), sections_.end(), [&](const SectionInfo& s) {
        return s.kind == kind && s.body == body;
    });
    return found == sections_.end() ? nullptr : &*found;
}

std::string_view CacheFile::text(std::string_view kind, std::uint32_t body) const {
    const auto characters = section<char>(kind, body);
    return {characters.data(), characters.size()};
}

SectionParts CacheFile::partsOf(const SectionInfo& info) const {
    const std::uint64_t parts = cachePartCount(info.count, cachePartShift(info.elementBytes));
    return {path_.string(), info, file_.bytes().subspan(info.offset, info.bytes),
            checksums_.subspan(info.firstPart, parts)};
}

SectionParts CacheFile::partsOf(std::string_view kind, std::uint32_t body,
                                std::size_t elementBytes) const {
    const SectionInfo* info = find(kind, body);
    if (!info)
        throw Error(ErrorKind::BadInput, path_.string(),
                    fmt::format("has no section '{}' of body {}", kind, body), kRebuild);
    if (info->elementBytes != elementBytes)
        throw Error(ErrorKind::BadInput, path_.string(),
                    fmt::format("section '{}' of body {} has elements of {} bytes, not {}", kind,
                                body, info->elementBytes, elementBytes),
                    kRebuild);
    return partsOf(*info);
}

}  // namespace sss
