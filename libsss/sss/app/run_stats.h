#pragma once
#include "sss/base/json.h"
#include "sss/base/stopwatch.h"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace sss {

/// What a run cost and made, for --stats: seconds a phase, counts, values, peak memory. Every call
/// may come from any thread.
class RunStats {
    struct Phase;

public:
    /// Adds the time until it is destroyed to its phase.
    class Timer {
    public:
        ~Timer();
        Timer(const Timer&) = delete;
        Timer& operator=(const Timer&) = delete;

    private:
        friend class RunStats;
        Timer(RunStats& stats, std::string_view phase);
        RunStats& stats_;
        Phase&
            phase_;  // there from the start: where memory is out, nothing can be added at the end
        Stopwatch wall_;
        double cpuBegan_;
    };

    /// The clock of "total" starts here.
    explicit RunStats(std::string program);

    /// Times a phase, by the wall and by the CPU seconds of all threads of the process:
    /// `const auto timer = stats.seconds("points");`. A phase met again adds up.
    [[nodiscard]] Timer seconds(std::string_view phase) { return Timer(*this, phase); }
    /// Adds to a counter (points, nodes, rays); counters never touched are not written.
    void count(std::string_view name, std::uint64_t amount);
    /// Sets a value: a number, text, or an array or object of them.
    void value(std::string_view name, JsonValue value);

    double wallSeconds(std::string_view phase) const;
    /// Since the start.
    double wallSeconds() const;
    double cpuSeconds() const;
    std::uint64_t counter(std::string_view name) const;

    /// {"program", "seconds": {phase..., "total"}, "cpuSeconds": {phase..., "total"},
    ///  "counts": {...}, "values": {...}, "peakMemoryBytes"}; phases, counts and values in the
    ///  order
    /// they first came.
    JsonValue toJson() const;
    /// toJson() as a file. Throws Error{Io}.
    void writeStats(const std::filesystem::path& path) const;

private:
    struct Phase {
        std::string name;
        double wallSeconds = 0, cpuSeconds = 0;
    };
    struct Counter {
        std::string name;
        std::uint64_t amount = 0;
    };
    Phase& startedPhase(std::string_view name);

    std::string program_;
    Stopwatch sinceStart_;
    std::deque<Phase> phases_;  // which stay where they are
    std::vector<Counter> counters_;
    JsonValue values_ = JsonValue::object();
    mutable std::mutex mutex_;
};

/// The most memory this process has had resident so far, in bytes.
std::uint64_t peakMemoryBytes();

}  // namespace sss
