#pragma once
#include "sss/base/reporter.h"

#include <cstddef>
#include <cstdio>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace sss {

/// How progress is told: a bar on a terminal and lines elsewhere, lines, lines of JSON, not at all.
enum class ProgressStyle { Automatic, Plain, Json, None };
/// "plain", "json" or "none". Throws Error{Usage} at `where`.
ProgressStyle progressStyle(std::string_view name, const std::string& where);

struct TerminalOptions {
    bool quiet = false;  ///< only warnings
    std::FILE* stream = stderr;
    std::optional<bool> isTerminal;          ///< default: what `stream` is
    std::function<double()> elapsedSeconds;  ///< default: since construction; for tests
    ProgressStyle progress = ProgressStyle::Automatic;
};

/// The log of both programs: one line an event. On a terminal progress is a bar with the time left
/// that redraws itself; elsewhere it is a PROGRESS line at most every 2 s, for phases over 1 s
/// only; as JSON {"frame", "position", "frames", "phase", "fraction", "secondsLeft"}, also at a
/// phase's end.
class TerminalReporter final : public Reporter {
public:
    explicit TerminalReporter(TerminalOptions options = {});
    ~TerminalReporter() override;
    TerminalReporter(const TerminalReporter&) = delete;
    TerminalReporter& operator=(const TerminalReporter&) = delete;

    void info(std::string_view module, std::string_view sentence) override;
    void warn(std::string_view module, std::string_view sentence) override;
    void progress(std::string_view phase, double fraction, double secondsLeft, bool done) override;

    /// What is worked at: the number of a frame, the `position`th (from 1) of `frames`.
    void beginFrame(int number, std::size_t position, std::size_t frames);

    std::size_t warningCount() const;
    /// For --strict, once the work is done: throws Error{Strict} if there was any warning.
    void requireNoWarnings() const;

private:
    void printLine(std::string_view level, std::string_view module, std::string_view sentence);
    void printJson(std::string_view phase, double fraction, double secondsLeft);
    void eraseBar();
    void drawBar(std::string_view phase, double fraction, double secondsLeft);

    TerminalOptions options_;
    bool isTerminal_ = false, isBarDrawn_ = false;
    std::string phase_;  ///< that the next two speak of
    double phaseBegan_ = 0, lastPrinted_ = 0;
    bool isPhasePrinted_ = false;
    struct FramePlace {
        int number;
        std::size_t position, frames;
    };
    std::optional<FramePlace> frame_;
    std::size_t warnings_ = 0;
    mutable std::mutex mutex_;
};

/// "17 s left", "3 min left", "2.1 h left"; "" if `seconds` is negative.
std::string timeLeftText(double seconds);

}  // namespace sss
