#include "sss/base/sampler.h"

#include <array>

namespace sss {
namespace {

constexpr std::uint32_t reverseBits(std::uint32_t x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

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

// `x` comes and goes with its bits reversed.
constexpr std::uint32_t shuffledIndexReversed(std::uint32_t index, std::uint32_t seed) {
    return laineKarras(reverseBits(index), seed);
}

// Second Sobol dimension (van der Corput in the Pascal matrix), bits reversed on output. Indices
// are shuffled over all 32 bits, so they are taken byte by byte: the matrix is linear.
constexpr std::uint32_t sobolSecondByBits(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t v = 1u << 31; index; index >>= 1, v ^= v >> 1)
        if (index & 1u) result ^= v;
    return result;
}

constexpr auto kSobolBytes = [] {
    std::array<std::array<std::uint32_t, 256>, 4> table{};
    for (std::uint32_t byte = 0; byte < 4; ++byte)
        for (std::uint32_t value = 0; value < 256; ++value)
            table[byte][value] = sobolSecondByBits(value << (8 * byte));
    return table;
}();

constexpr std::uint32_t sobolSecond(std::uint32_t index) {
    return kSobolBytes[0][index & 255u] ^ kSobolBytes[1][index >> 8 & 255u] ^
           kSobolBytes[2][index >> 16 & 255u] ^ kSobolBytes[3][index >> 24];
}

}  // namespace

float Sampler::next1D() {
    const std::uint64_t hash = combineSeeds(seed_, dimension_++);
    const std::uint32_t shuffle = static_cast<std::uint32_t>(hash);
    const std::uint32_t scramble = static_cast<std::uint32_t>(hash >> 32);
    // The radical inverse of the shuffled index is its reversed form; scramble that.
    const std::uint32_t index = reverseBits(shuffledIndexReversed(index_, shuffle));
    return unitFloat(reverseBits(laineKarras(index, scramble)));
}

Vec2 Sampler::next2D() {
    const std::uint64_t hash = combineSeeds(seed_, dimension_++);
    const std::uint64_t hash2 = mix64(hash + 1);
    const std::uint32_t index =
        reverseBits(shuffledIndexReversed(index_, static_cast<std::uint32_t>(hash)));
    const std::uint32_t x = reverseBits(laineKarras(index, static_cast<std::uint32_t>(hash >> 32)));
    const std::uint32_t y = reverseBits(
        laineKarras(reverseBits(sobolSecond(index)), static_cast<std::uint32_t>(hash2 >> 32)));
    return {unitFloat(x), unitFloat(y)};
}

}  // namespace sss
