#include "sss/cloud/cache_writer.h"

#include "sss/base/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace sss {
namespace {

[[noreturn]] void refuse(std::string_view kind, const char* why) {
    throw Error(ErrorKind::Internal, "cache",
                fmt::format("cannot add section '{}': {}", kind, why));
}

bool isValidKind(std::string_view kind) {
    return !kind.empty() && kind.size() <= 8 &&
           std::all_of(kind.begin(), kind.end(), [](char c) { return c > ' ' && c < '\x7f'; });
}

}  // namespace

CacheWriter::CacheWriter(std::filesystem::path path) : file_(std::move(path)) {
    const CacheHeader placeholder;
    write(std::as_bytes(std::span(&placeholder, 1)));
}

void CacheWriter::addText(std::string_view kind, std::uint32_t body, const Fingerprint& fingerprint,
                          std::string_view text) {
    add(kind, body, fingerprint, std::span(text.data(), text.size()));
}

void CacheWriter::addBytes(std::string_view kind, std::uint32_t body, std::uint32_t elementBytes,
                           const Fingerprint& fingerprint, std::span<const std::byte> bytes) {
    if (!isValidKind(kind)) refuse(kind, "a kind is 1 to 8 printable ASCII characters");
    CacheEntry entry;
    std::copy(kind.begin(), kind.end(), entry.kind.begin());
    entry.body = body;
    const auto isSame = [&](const CacheEntry& e) {
        return e.kind == entry.kind && e.body == entry.body;
    };
    if (std::any_of(table_.begin(), table_.end(), isSame))
        refuse(kind, "it has been added before for this body");
    padToAlignment();
    entry.elementBytes = elementBytes;
    entry.count = bytes.size() / elementBytes;
    entry.offset = position_;
    entry.bytes = bytes.size();
    entry.firstPart = checksums_.size();
    entry.fingerprintLo = fingerprint.lo;
    entry.fingerprintHi = fingerprint.hi;
    const std::size_t partBytes = std::size_t{elementBytes} << cachePartShift(elementBytes);
    for (auto rest = bytes; !rest.empty(); rest = rest.subspan(std::min(partBytes, rest.size())))
        checksums_.push_back(checksum(rest.first(std::min(partBytes, rest.size()))));
    write(bytes);
    table_.push_back(entry);
}

void CacheWriter::commit() {
    padToAlignment();
    CacheHeader header;
    header.sectionCount = table_.size();
    header.tableOffset = position_;
    const auto entries = std::as_bytes(std::span(table_));
    const auto checksums = std::as_bytes(std::span(checksums_));
    std::vector<std::byte> table(entries.begin(), entries.end());
    table.insert(table.end(), checksums.begin(), checksums.end());
    write(table);
    header.fileBytes = position_;
    header.checksum = cacheHeaderChecksum(header, table);
    file_.overwrite(0, std::as_bytes(std::span(&header, 1)));
    file_.commit();
}

void CacheWriter::padToAlignment() {
    constexpr std::array<std::byte, kCacheAlignment> kZeros{};
    const std::uint64_t over = position_ % kCacheAlignment;
    if (over != 0) write(std::span(kZeros).first(kCacheAlignment - over));
}

void CacheWriter::write(std::span<const std::byte> bytes) {
    file_.append(bytes);
    position_ += bytes.size();
}

}  // namespace sss
