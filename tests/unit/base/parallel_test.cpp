#include "sss/base/parallel_sort.h"
#include "sss/base/rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace sss {
namespace {

TEST(ParallelFor, CoversEveryIndexOnce) {
    for (const std::size_t count : {0u, 1u, 7u, 64u, 1000u, 100'003u})
        for (const std::size_t grain : {0u, 1u, 3u, 64u, 1'000'000u}) {
            std::vector<std::atomic<int>> hits(count);
            parallelFor(count, grain, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) hits[i]++;
            });
            for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(hits[i], 1) << i << " of " << count;
        }
}

TEST(ParallelFor, RangesDoNotDependOnTheThreads) {
    const auto rangesWith = [](unsigned threads) {
        const ThreadLimit limit(threads);
        std::vector<std::size_t> ends(1000, 0);
        parallelFor(1000, 37, [&](std::size_t begin, std::size_t end) { ends[begin] = end; });
        return ends;
    };
    const std::vector<std::size_t> one = rangesWith(1);
    EXPECT_EQ(one, rangesWith(2));
    EXPECT_EQ(one, rangesWith(4));
    for (std::size_t begin = 0; begin < one.size(); ++begin)
        EXPECT_EQ(one[begin], begin % 37 == 0 ? std::min<std::size_t>(1000, begin + 37) : 0u);
}

TEST(ParallelFor, SumsInOrderAreTheSameBitsForAnyThreads) {
    const auto sumWith = [](unsigned threads) {
        const ThreadLimit limit(threads);
        constexpr std::size_t kCount = 100'000, kGrain = 256;
        std::vector<float> partial((kCount + kGrain - 1) / kGrain);
        parallelFor(kCount, kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                partial[begin / kGrain] += 1.0f / static_cast<float>(i + 1);
        });
        return std::accumulate(partial.begin(), partial.end(), 0.0f);
    };
    EXPECT_EQ(sumWith(1), sumWith(2));
    EXPECT_EQ(sumWith(1), sumWith(3));
    EXPECT_NEAR(sumWith(1), 12.0901, 1e-3);  // H_100000
}

TEST(ParallelFor, ExceptionsComeOut) {
    EXPECT_THROW(parallelFor(1000, 10,
                             [](std::size_t begin, std::size_t) {
                                 if (begin == 500) throw std::runtime_error("500");
                             }),
                 std::runtime_error);
}

TEST(ParallelFor, Nests) {
    std::atomic<int> total{0};
    parallelFor(8, 1, [&](std::size_t, std::size_t) {
        parallelFor(100, 7, [&](std::size_t begin, std::size_t end) {
            total += static_cast<int>(end - begin);
        });
    });
    EXPECT_EQ(total, 800);
}

TEST(ThreadLimit, HoldsWhileItLives) {
    const unsigned before = ThreadLimit::current();
    {
        const ThreadLimit one(1);
        EXPECT_EQ(ThreadLimit::current(), 1u);
    }
    EXPECT_EQ(ThreadLimit::current(), before);
}

TEST(ParallelSort, AsSortDoesForAnyLengthAndThreads) {
    for (const unsigned threads : {1u, 2u, 3u}) {
        const ThreadLimit limit(threads);
        for (const std::size_t count : {0u, 1u, 32'768u, 32'769u, 200'000u}) {
            Rng rng(count + 1);
            std::vector<std::uint64_t> items(count);
            for (std::uint64_t& item : items) item = rng.next64() % 1000;
            std::vector<std::uint64_t> expected = items;
            std::sort(expected.begin(), expected.end());
            parallelSort(std::span(items), std::less<>());
            EXPECT_EQ(items, expected) << count;
        }
    }
}

}  // namespace
}  // namespace sss
