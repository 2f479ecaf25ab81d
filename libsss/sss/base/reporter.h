#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

namespace sss {

/// Where the library's words go. The library never prints; each program brings its own reporter.
/// Every call may come from any thread.
class Reporter {
public:
    virtual ~Reporter() = default;
    virtual void info(std::string_view module, std::string_view sentence) = 0;
    virtual void warn(std::string_view module, std::string_view sentence) = 0;
    /// `fraction` in [0, 1]; `secondsLeft` < 0 while unknown. `done` comes exactly once a phase.
    virtual void progress(std::string_view phase, double fraction, double secondsLeft,
                          bool done) = 0;
};

/// Swallows everything: for tests and for calls made inside other calls.
class SilentReporter final : public Reporter {
public:
    void info(std::string_view, std::string_view) override {}
    void warn(std::string_view, std::string_view) override {}
    void progress(std::string_view, double, double, bool) override {}
};

/// Counts the work of one phase and tells the reporter at most ten times a second.
class Progress {
public:
    Progress(Reporter& reporter, std::string phase, std::uint64_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// Thread-safe; a few nanoseconds unless it is time to report.
    void advance(std::uint64_t amount = 1);

private:
    using Clock = std::chrono::steady_clock;
    Reporter& reporter_;
    std::string phase_;
    std::uint64_t total_;
    Clock::time_point start_;
    std::atomic<std::uint64_t> done_{0};
    std::atomic<std::int64_t> nextReportNs_;
    std::mutex mutex_;
};

}  // namespace sss
