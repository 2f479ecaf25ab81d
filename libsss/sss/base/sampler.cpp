#include "sss/base/sampler.h"

#include "sss/base/assert.h"

#include <algorithm>
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

// Second Sobol dimension, its bits reversed: the Pascal matrix modulo 2, which by Lucas' theorem is
// the fifth Kronecker power of a matrix of 2 x 2, and so a step for each.
constexpr std::uint32_t sobolSecondReversed(std::uint32_t index) {
    index ^= index >> 16 & 0x0000ffffu;
    index ^= index >> 8 & 0x00ff00ffu;
    index ^= index >> 4 & 0x0f0f0f0fu;
    index ^= index >> 2 & 0x33333333u;
    return index ^ (index >> 1 & 0x55555555u);
}

// What a pair of numbers is scrambled by, in all samples of a pixel.
struct PairSeeds {
    PairSeeds(std::uint64_t seed, std::uint32_t dimension) {
        const std::uint64_t hash = combineSeeds(seed, dimension);
        shuffle = static_cast<std::uint32_t>(hash);
        x = static_cast<std::uint32_t>(hash >> 32);
        y = static_cast<std::uint32_t>(mix64(hash + 1) >> 32);
    }
    std::uint32_t shuffle, x, y;
};

// The shuffle is an Owen scramble of the index's reversed bits; the radical inverse of the shuffled
// index is that again, whose own scramble acts on the shuffled index.
Vec2 pairOf(std::uint32_t reversedIndex, const PairSeeds& seeds) {
    const std::uint32_t index = reverseBits(laineKarras(reversedIndex, seeds.shuffle));
    return {unitFloat(reverseBits(laineKarras(index, seeds.x))),
            unitFloat(reverseBits(laineKarras(sobolSecondReversed(index), seeds.y)))};
}

}  // namespace

Sampler::Sampler(std::uint64_t seed, std::uint32_t index)
    : seed_(seed), index_(index), reversedIndex_(reverseBits(index)) {}

float Sampler::next1D() {
    const std::uint64_t hash = combineSeeds(seed_, dimension_++);
    const std::uint32_t reversed = laineKarras(reversedIndex_, static_cast<std::uint32_t>(hash));
    return unitFloat(
        reverseBits(laineKarras(reverseBits(reversed), static_cast<std::uint32_t>(hash >> 32))));
}

Vec2 Sampler::next2D() { return pairOf(reversedIndex_, {seed_, dimension_++}); }

void Sampler::next2D(std::span<Sampler> samplers, std::span<Vec2> values) {
    if (samplers.empty()) return;
    const std::uint64_t seed = samplers.front().seed_;
    const std::uint32_t dimension = samplers.front().dimension_;
    const PairSeeds seeds(seed, dimension);
    // Apart from the samplers, so that several go through the same steps at once.
    constexpr std::size_t kChunk = 16;
    for (std::size_t first = 0; first < samplers.size(); first += kChunk) {
        const std::span<Sampler> some =
            samplers.subspan(first, std::min(kChunk, samplers.size() - first));
        std::array<std::uint32_t, kChunk> indices{};
        for (std::size_t i = 0; i < some.size(); ++i) {
            SSS_ASSERT_EQ(some[i].seed_, seed);
            SSS_ASSERT_EQ(some[i].dimension_, dimension);
            indices[i] = some[i].reversedIndex_;
            ++some[i].dimension_;
        }
        std::array<Vec2, kChunk> pairs;
        for (std::size_t i = 0; i < kChunk; ++i) pairs[i] = pairOf(indices[i], seeds);
        std::copy_n(pairs.begin(), some.size(), values.begin() + first);
    }
}

}  // namespace sss
