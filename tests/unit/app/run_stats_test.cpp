#include "sss/app/run_stats.h"

#include "sss/base/error.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <thread>

namespace sss {
namespace {

const JsonValue& at(const JsonValue& object, std::string_view key) {
    const JsonMember* member = object.find(key);
    if (!member) throw std::runtime_error("no key " + std::string(key));
    return member->value;
}

TEST(RunStats, TimersAddUpByPhase) {
    RunStats stats("sss-test");
    for (int i = 0; i < 2; ++i) {
        const auto timer = stats.seconds("nap");
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
    EXPECT_GE(stats.wallSeconds("nap"), 0.06);
    EXPECT_EQ(stats.wallSeconds("other"), 0.0);
    const JsonValue json = stats.toJson();
    EXPECT_EQ(at(at(json, "seconds"), "nap").asNumber(), stats.wallSeconds("nap"));
    EXPECT_GE(at(at(json, "seconds"), "total").asNumber(), stats.wallSeconds("nap"));
    // Sleeping costs the wall time but no CPU.
    EXPECT_LT(at(at(json, "cpuSeconds"), "nap").asNumber(), 0.03);
}

TEST(RunStats, CpuSecondsSumOverThreads) {
    RunStats stats("sss-test");
    const auto threadSeconds = [] {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const auto burn = [&] {
        const double end = threadSeconds() + 0.04;
        while (threadSeconds() < end) {
        }
    };
    {
        const auto timer = stats.seconds("burn");
        std::thread other(burn);
        burn();
        other.join();
    }
    EXPECT_GE(at(at(stats.toJson(), "cpuSeconds"), "burn").asNumber(), 0.08);
}

TEST(RunStats, CountersFromManyThreads) {
    RunStats stats("sss-test");
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            for (int k = 0; k < 1000; ++k) stats.count("rays", 2);
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(stats.counter("rays"), 8000u);
}

TEST(RunStats, FileHoldsEverythingInOrder) {
    const testing::TemporaryFolder folder;
    RunStats stats("sss-test");
    { const auto timer = stats.seconds("points"); }
    { const auto timer = stats.seconds("irradiance"); }
    stats.count("points", 118204);
    stats.count("nodes", 5);
    stats.value("spacingMm", 0.42);
    stats.value("meanFreePathMm", JsonValue::array({1.5, 2.0, 2.5}));
    stats.writeStats(folder / "stats.json");
    const JsonValue json = readJsonFile(folder / "stats.json");
    EXPECT_EQ(at(json, "program").asString(), "sss-test");
    ASSERT_EQ(at(json, "seconds").members().size(), 3u);
    EXPECT_EQ(at(json, "seconds").members()[0].key, "points");
    EXPECT_EQ(at(json, "seconds").members()[1].key, "irradiance");
    EXPECT_EQ(at(json, "seconds").members()[2].key, "total");
    EXPECT_EQ(at(at(json, "counts"), "points").asNumber(), 118204);
    EXPECT_EQ(at(at(json, "values"), "spacingMm").asNumber(), 0.42);
    EXPECT_EQ(at(at(json, "values"), "meanFreePathMm").items()[2].asNumber(), 2.5);
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(RunStats, PeakMemoryGrowsWithUse) {
    const std::uint64_t before = peakMemoryBytes();
    EXPECT_GT(before, 1u << 20);
    constexpr std::size_t kBytes = std::size_t{64} << 20;
    const std::vector<char> much(kBytes + before, 1);
    EXPECT_GE(peakMemoryBytes(), before + much[before] * kBytes / 2);
}

TEST(RunStats, UnwritableFileIsAnIoError) {
    try {
        RunStats("sss-test").writeStats("/no-such-folder/stats.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.exitCode(), 4);
    }
}

}  // namespace
}  // namespace sss
