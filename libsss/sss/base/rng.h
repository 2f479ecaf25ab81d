#pragma once
#include "sss/base/vec.h"

#include <cstdint>

namespace sss {

/// Mixes 64 bits (the finaliser of splitmix64); a bijection.
constexpr std::uint64_t mix64(std::uint64_t x) {
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ull;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/// Bit i becomes bit 31 - i (63 - i): halves, pairs of bytes and so on are exchanged.
constexpr std::uint32_t reverseBits(std::uint32_t x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}
constexpr std::uint64_t reverseBits(std::uint64_t x) {
    x = (x << 32) | (x >> 32);
    x = ((x & 0x0000ffff0000ffffull) << 16) | ((x & 0xffff0000ffff0000ull) >> 16);
    x = ((x & 0x00ff00ff00ff00ffull) << 8) | ((x & 0xff00ff00ff00ff00ull) >> 8);
    x = ((x & 0x0f0f0f0f0f0f0f0full) << 4) | ((x & 0xf0f0f0f0f0f0f0f0ull) >> 4);
    x = ((x & 0x3333333333333333ull) << 2) | ((x & 0xccccccccccccccccull) >> 2);
    return ((x & 0x5555555555555555ull) << 1) | ((x & 0xaaaaaaaaaaaaaaaaull) >> 1);
}

/// Order-dependent combination of two values into one well-mixed seed.
constexpr std::uint64_t combineSeeds(std::uint64_t a, std::uint64_t b) {
    return mix64(a + 0x9e3779b97f4a7c15ull * (b + 1));
}

/// The 24 high bits of `bits` as a float in [0, 1): never 1, so that log(1 - u) is finite.
constexpr float unitFloat(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// A small counter-based generator: stream = seed, position = counter. Any thread that knows the
/// seed gets the same numbers.
class Rng {
public:
    explicit constexpr Rng(std::uint64_t seed) : state_(seed) {}
    constexpr std::uint64_t next64() { return mix64(state_ += 0x9e3779b97f4a7c15ull); }
    constexpr std::uint32_t next32() { return static_cast<std::uint32_t>(next64() >> 32); }
    /// In [0, 1).
    constexpr float uniform() { return unitFloat(next32()); }
    /// In [0, 1), 53 bits.
    constexpr double uniformDouble() { return static_cast<double>(next64() >> 11) * 0x1p-53; }
    Vec2 uniform2() {
        const float x = uniform();
        return {x, uniform()};
    }

private:
    std::uint64_t state_;
};

}  // namespace sss
