#include "sss/base/sampler.h"

#include <array>

namespace sss {
namespace {

// Laine-Karras permutation with the improved constants of Vegdahl: acts on bits from low to high,
// which on bit-reversed numbers is an Owen scramble.
constexpr std::uint32_t laineKarras(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Second Sobol dimension (van der Corput in the Pascal matrix), as its bits come out: reversed.
constexpr std::uint32_t sobolSecondByBits(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t v = 1u << 31; index; index >>= 1, v ^= v >> 1)
        if (index & 1u) result ^= v;
    return result;
}

// The matrix is linear, so indices, which are shuffled over all 32 bits, are taken byte by byte.
// The table holds it between two bit reversals, which neither side of it then needs.
constexpr auto kSobolBytes = [] {
    std::array<std::array<std::uint32_t, 256>, 4> table{};
    for (std::uint32_t byte = 0; byte < 4; ++byte)
        for (std::uint32_t value = 0; value < 256; ++value)
            table[byte][value] = reverseBits(sobolSecondByBits(reverseBits(value << (8 * byte))));
    return table;
}();

constexpr std::uint32_t sobolSecondReversed(std::uint32_t reversedIndex) {
    return kSobolBytes[0][reversedIndex & 255u] ^ kSobolBytes[1][reversedIndex >> 8 & 255u] ^
           kSobolBytes[2][reversedIndex >> 16 & 255u] ^ kSobolBytes[3][reversedIndex >> 24];
}

}  // namespace

Sampler::Sampler(std::uint64_t seed, std::uint32_t index)
    : seed_(seed), index_(index), reversedIndex_(reverseBits(index)) {}

// The shuffle is an Owen scramble of the index's reversed bits; the radical inverse of the shuffled
// index is that again, whose own scramble acts on the shuffled index.

float Sampler::next1D() {
    const std::uint64_t hash = combineSeeds(seed_, dimension_++);
    const std::uint32_t reversed = laineKarras(reversedIndex_, static_cast<std::uint32_t>(hash));
    return unitFloat(
        reverseBits(laineKarras(reverseBits(reversed), static_cast<std::uint32_t>(hash >> 32))));
}

Vec2 Sampler::next2D() {
    const std::uint64_t hash = combineSeeds(seed_, dimension_++);
    const std::uint64_t hash2 = mix64(hash + 1);
    const std::uint32_t reversed = laineKarras(reversedIndex_, static_cast<std::uint32_t>(hash));
    const std::uint64_t x =
        laineKarras(reverseBits(reversed), static_cast<std::uint32_t>(hash >> 32));
    const std::uint64_t y =
        laineKarras(sobolSecondReversed(reversed), static_cast<std::uint32_t>(hash2 >> 32));
    // Both in one go, which also exchanges them.
    const std::uint64_t both = reverseBits(x | y << 32);
    return {unitFloat(static_cast<std::uint32_t>(both >> 32)),
            unitFloat(static_cast<std::uint32_t>(both))};
}

}  // namespace sss
