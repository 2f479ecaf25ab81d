#include "sss/base/reporter.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace sss {
namespace {

struct Call {
    std::string phase;
    double fraction, secondsLeft;
    bool done;
};

class RecordingReporter final : public Reporter {
public:
    void info(std::string_view, std::string_view) override {}
    void warn(std::string_view, std::string_view) override {}
    void progress(std::string_view phase, double fraction, double secondsLeft, bool done) override {
        const std::lock_guard lock(mutex_);
        calls.push_back({std::string(phase), fraction, secondsLeft, done});
    }
    std::vector<Call> calls;

private:
    std::mutex mutex_;
};

TEST(Progress, DoneComesExactlyOnceAndLast) {
    RecordingReporter reporter;
    {
        Progress progress(reporter, "points", 1'000'000);
        std::vector<std::thread> threads;
        for (int i = 0; i < 4; ++i)
            threads.emplace_back([&] {
                for (int k = 0; k < 250'000; ++k) progress.advance();
            });
        for (std::thread& thread : threads) thread.join();
    }
    ASSERT_FALSE(reporter.calls.empty());
    for (std::size_t i = 0; i + 1 < reporter.calls.size(); ++i)
        EXPECT_FALSE(reporter.calls[i].done);
    EXPECT_TRUE(reporter.calls.back().done);
    EXPECT_EQ(reporter.calls.back().fraction, 1.0);
    EXPECT_EQ(reporter.calls.back().phase, "points");
}

TEST(Progress, TimeLeftFollowsFromTheFractionDone) {
    RecordingReporter reporter;
    const auto began = std::chrono::steady_clock::now();
    {
        Progress progress(reporter, "render", 4);
        progress.advance();  // within the first tenth of a second: not reported
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
        progress.advance();
    }
    const std::chrono::duration<double> all = std::chrono::steady_clock::now() - began;
    ASSERT_EQ(reporter.calls.size(), 2u);
    EXPECT_EQ(reporter.calls[0].fraction, 0.5);
    // Half is done: as long again, measured between the sleep and the end of the test.
    EXPECT_GE(reporter.calls[0].secondsLeft, 0.15);
    EXPECT_LE(reporter.calls[0].secondsLeft, all.count());
}

TEST(Progress, MoreWorkThanAnnouncedStaysAtOne) {
    RecordingReporter reporter;
    {
        Progress progress(reporter, "empty", 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(110));
        progress.advance(5);
    }
    ASSERT_EQ(reporter.calls.size(), 2u);
    EXPECT_EQ(reporter.calls[0].fraction, 1.0);
    EXPECT_EQ(reporter.calls[0].secondsLeft, 0.0);
}

TEST(Progress, IsRareWhateverTheCalls) {
    RecordingReporter reporter;
    const auto began = std::chrono::steady_clock::now();
    std::chrono::duration<double> elapsed{};
    {
        Progress progress(reporter, "points", 1u << 30);
        while (elapsed.count() < 0.35) {
            progress.advance();
            elapsed = std::chrono::steady_clock::now() - began;
        }
    }
    // Ten a second at most, and the one at the end.
    EXPECT_GE(reporter.calls.size(), 2u);
    EXPECT_LE(static_cast<double>(reporter.calls.size()), elapsed.count() * 10 + 1);
}

}  // namespace
}  // namespace sss
