#include "sss/base/rng.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <set>

namespace sss {
namespace {

// The first outputs of splitmix64 [Steele et al. 2014] for seed 1234567, as published with the
// Rosetta Code task of that name.
TEST(Rng, IsSplitMix64) {
    Rng rng(1234567);
    for (const std::uint64_t expected :
         {6457827717110365317ull, 3203168211198807973ull, 9817491932198370423ull,
          4593380528125082431ull, 16408922859458223821ull})
        EXPECT_EQ(rng.next64(), expected);
}

TEST(Rng, UnitFloatNeverReachesOne) {
    EXPECT_EQ(unitFloat(0), 0.0f);
    EXPECT_LT(unitFloat(0xffffffffu), 1.0f);
    EXPECT_EQ(unitFloat(0x80000000u), 0.5f);
}

TEST(Rng, UniformHasTheMomentsOfTheUniformDistribution) {
    Rng rng(7);
    constexpr int kCount = 200'000;
    double sum = 0, squares = 0;
    std::array<int, 16> bins{};
    for (int i = 0; i < kCount; ++i) {
        const double u = rng.uniform();
        ASSERT_GE(u, 0.0);
        ASSERT_LT(u, 1.0);
        sum += u;
        squares += u * u;
        bins[static_cast<std::size_t>(u * 16)]++;
    }
    // Four standard deviations of the mean of u (1/sqrt(12 n)) and of u^2 (sqrt(4/45 / n)).
    EXPECT_NEAR(sum / kCount, 0.5, 4 * 6.5e-4);
    EXPECT_NEAR(squares / kCount, 1.0 / 3.0, 4 * 6.7e-4);
    double chiSquared = 0;
    for (const int n : bins)
        chiSquared += (n - kCount / 16.0) * (n - kCount / 16.0) / (kCount / 16.0);
    EXPECT_LT(chiSquared, 37.7);  // 15 degrees of freedom, p = 0.001
}

TEST(Rng, UniformDoubleUsesLowBits) {
    Rng rng(3);
    bool hasFineBits = false;
    for (int i = 0; i < 100; ++i) {
        const double u = rng.uniformDouble();
        ASSERT_GE(u, 0.0);
        ASSERT_LT(u, 1.0);
        hasFineBits = hasFineBits || static_cast<double>(static_cast<float>(u)) != u;
    }
    EXPECT_TRUE(hasFineBits);
}

TEST(Rng, Uniform2TakesXFirst) {
    Rng a(11), b(11);
    const Vec2 both = a.uniform2();
    EXPECT_EQ(both.x, b.uniform());
    EXPECT_EQ(both.y, b.uniform());
}

TEST(CombineSeeds, DependsOnOrderAndSpreadsNeighbours) {
    EXPECT_NE(combineSeeds(1, 2), combineSeeds(2, 1));
    std::set<std::uint64_t> seen;
    int flipped = 0;
    for (std::uint64_t a = 0; a < 100; ++a)
        for (std::uint64_t b = 0; b < 100; ++b) {
            seen.insert(combineSeeds(a, b));
            flipped += std::popcount(combineSeeds(a, b) ^ combineSeeds(a, b + 1));
        }
    EXPECT_EQ(seen.size(), 10'000u);
    EXPECT_NEAR(flipped / 10'000.0, 32.0, 0.25);  // avalanche; the mean of 10^4 has sd 0.04
}

TEST(ReverseBits, BitsChangePlaces) {
    for (unsigned i = 0; i < 32; ++i)
        EXPECT_EQ(reverseBits(std::uint32_t{1} << i), std::uint32_t{1} << (31 - i));
    for (unsigned i = 0; i < 64; ++i)
        EXPECT_EQ(reverseBits(std::uint64_t{1} << i), std::uint64_t{1} << (63 - i));
    EXPECT_EQ(reverseBits(0x80000001u | 0x00ff0000u), 0x80000001u | 0x0000ff00u);
}

}  // namespace
}  // namespace sss
