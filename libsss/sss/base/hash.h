#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace sss {

/// 128-bit content hash of exactly the inputs that a result depends on.
struct Fingerprint {
    std::uint64_t lo = 0, hi = 0;
    bool operator==(const Fingerprint&) const = default;
    /// 32 lower-case hexadecimal digits.
    std::string hex() const;
};

/// Builds a Fingerprint (XXH3-128) from a sequence of values. Sizes are hashed with the contents,
/// so that ("ab","c") and ("a","bc") differ. -0.0 and 0.0 count as the same number.
class Hasher {
public:
    Hasher();
    ~Hasher();
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;

    Hasher& add(std::string_view text);
    Hasher& add(double value);
    Hasher& add(std::uint64_t value);
    Hasher& add(const Fingerprint& value);
    /// Raw bytes of trivially copyable elements; they must hold no padding.
    template <typename T>
    Hasher& add(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        return addBytes(values.data(), values.size_bytes());
    }
    Fingerprint finish() const;

private:
    Hasher& addBytes(const void* data, std::size_t bytes);
    void* state_;
};

/// 64-bit XXH3 checksum of raw bytes, for files.
std::uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace sss
