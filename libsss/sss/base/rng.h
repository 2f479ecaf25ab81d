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
