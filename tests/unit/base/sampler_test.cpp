#include "sss/base/sampler.h"

#include <gtest/gtest.h>

#include <vector>

namespace sss {
namespace {

TEST(Sampler, EveryPairIsStratifiedInAllElementaryIntervals) {
    // The first 2^4 samples of a (0,2)-sequence hit each of the 16 cells of every 2^a x 2^b grid.
    for (std::uint64_t seed : {1u, 77u, 12345u}) {
        for (int a = 0; a <= 4; ++a) {
            const int nx = 1 << a, ny = 16 / nx;
            std::vector<int> cells(16, 0);
            for (std::uint32_t i = 0; i < 16; ++i) {
                Sampler sampler(seed, i);
                sampler.next2D();
                sampler.next1D();
                const Vec2 u = sampler.next2D();
                const int x = static_cast<int>(u.x * static_cast<float>(nx));
                const int y = static_cast<int>(u.y * static_cast<float>(ny));
                ++cells[static_cast<std::size_t>(y * nx + x)];
            }
            for (int count : cells) EXPECT_EQ(count, 1);
        }
    }
}

TEST(Sampler, OneDimensionIsStratified) {
    std::vector<int> cells(64, 0);
    for (std::uint32_t i = 0; i < 64; ++i)
        ++cells[static_cast<std::size_t>(Sampler(9, i).next1D() * 64.0f)];
    for (int count : cells) EXPECT_EQ(count, 1);
}

TEST(Sampler, PairsAreUncorrelated) {
    double sum = 0;
    const int n = 4096;
    for (std::uint32_t i = 0; i < n; ++i) {
        Sampler sampler(3, i);
        const Vec2 a = sampler.next2D(), b = sampler.next2D();
        sum += (a.x - 0.5) * (b.x - 0.5) + (a.y - 0.5) * (b.y - 0.5);
    }
    EXPECT_NEAR(sum / n, 0.0, 4.0 * std::sqrt(2.0) / 12.0 / std::sqrt(n));
}

TEST(Sampler, SkippingChangesNothingAfter) {
    Sampler whole(4, 5), skipping(4, 5);
    whole.next2D();
    whole.next1D();
    skipping.skip(2);
    EXPECT_EQ(whole.next2D(), skipping.next2D());
}

TEST(Sampler, BranchesAreStratifiedAndTheirOwn) {
    std::vector<int> cells(64, 0);
    double sum = 0;
    for (std::uint32_t i = 0; i < 64; ++i) {
        Sampler sampler(9, i), skipping(9, i);
        Sampler first = sampler.branch(), second = sampler.branch();
        skipping.skip(2);
        const float u = first.next1D(), v = second.next1D(), w = sampler.next1D();
        ++cells[static_cast<std::size_t>(u * 64.0f)];
        sum += (u - 0.5) * (v - 0.5) + (u - 0.5) * (w - 0.5);
        EXPECT_EQ(w, skipping.next1D());
    }
    for (int count : cells) EXPECT_EQ(count, 1);
    EXPECT_NEAR(sum / 64, 0.0, 4.0 * std::sqrt(2.0) / 12.0 / 8.0);
}

TEST(Sampler, NumbersTogetherAreThoseAlone) {
    std::vector<Sampler> together, alone;
    for (std::uint32_t i = 0; i < 37; ++i) {
        together.emplace_back(8, 3 * i);
        alone.emplace_back(8, 3 * i);
    }
    std::vector<Vec2> first(37), second(37);
    Sampler::next2D(together, first);
    Sampler::next2D(together, second);
    for (std::size_t i = 0; i < 37; ++i) {
        EXPECT_EQ(first[i], alone[i].next2D());
        EXPECT_EQ(second[i], alone[i].next2D());
        EXPECT_EQ(together[i].next1D(), alone[i].next1D());
    }
    Sampler::next2D({}, {});
}

// Pictures keep their noise when the sampler is made faster: the numbers of its first version, made
// with every bit reversed one after the other.
TEST(Sampler, NumbersStayAsTheyAre) {
    Sampler sampler(123, 6);
    const Vec2 a = sampler.next2D();
    const float b = sampler.next1D();
    EXPECT_EQ(a, Vec2(0x1.433d24p-1f, 0x1.bc36eap-1f));
    EXPECT_EQ(b, 0x1.ecbb8ep-1f);
}

}  // namespace
}  // namespace sss
