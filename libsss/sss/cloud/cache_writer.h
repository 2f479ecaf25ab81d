#pragma once
#include "sss/base/atomic_file.h"
#include "sss/base/hash.h"
#include "sss/cloud/cache_format.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace sss {

/// Writes a cache section by section; only checksums are kept in memory. Until commit() the file of
/// that name, if any, stays as it was. Failures throw Error{Io}.
class CacheWriter {
public:
    explicit CacheWriter(std::filesystem::path path);

    /// `kind`: 1 to 8 printable ASCII characters without blanks; (kind, body) must be new.
    /// Elements must hold no padding, or the same input would not give the same file.
    template <typename T>
    void add(std::string_view kind, std::uint32_t body, const Fingerprint& fingerprint,
             std::span<const T> elements) {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kCacheAlignment);
        addBytes(kind, body, sizeof(T), fingerprint, std::as_bytes(elements));
    }
    /// A section of text (JSON); its element size is 1.
    void addText(std::string_view kind, std::uint32_t body, const Fingerprint& fingerprint,
                 std::string_view text);
    void commit();

private:
    void addBytes(std::string_view kind, std::uint32_t body, std::uint32_t elementBytes,
                  const Fingerprint& fingerprint, std::span<const std::byte> bytes);
    void padToAlignment();
    void write(std::span<const std::byte> bytes);

    AtomicFile file_;
    std::vector<CacheEntry> table_;
    std::vector<std::uint64_t> checksums_;  // of all parts
    std::uint64_t position_ = 0;
};

}  // namespace sss
