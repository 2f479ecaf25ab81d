#include "sss/app/terminal_reporter.h"

#include "sss/app/log_line.h"
#include "sss/base/error.h"
#include "sss/base/json.h"
#include "sss/base/stopwatch.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

constexpr double kShortPhaseSeconds = 1.0;
constexpr double kPrintEverySeconds = 2.0;

int percent(double fraction) {
    return static_cast<int>(std::floor(100.0 * std::clamp(fraction, 0.0, 1.0)));
}

}  // namespace

ProgressStyle progressStyle(std::string_view name, const std::string& where) {
    if (name == "plain") return ProgressStyle::Plain;
    if (name == "json") return ProgressStyle::Json;
    if (name == "none") return ProgressStyle::None;
    throw Error(ErrorKind::Usage, where, fmt::format("\"{}\" is no way to tell progress", name),
                "say plain, json or none");
}

std::string timeLeftText(double seconds) {
    if (!(seconds >= 0)) return {};
    if (seconds < 99.5) return fmt::format("{:.0f} s left", seconds);
    if (seconds < 99.5 * 60) return fmt::format("{:.0f} min left", seconds / 60);
    return fmt::format("{:.1f} h left", seconds / 3600);
}

TerminalReporter::TerminalReporter(TerminalOptions options) : options_(std::move(options)) {
    isTerminal_ = options_.progress == ProgressStyle::Automatic &&
                  options_.isTerminal.value_or(isatty(fileno(options_.stream)) == 1);
    if (!options_.elapsedSeconds)
        options_.elapsedSeconds = [sinceStart = Stopwatch()] { return sinceStart.seconds(); };
}

TerminalReporter::~TerminalReporter() {
    const std::lock_guard lock(mutex_);
    eraseBar();
    std::fflush(options_.stream);
}

void TerminalReporter::info(std::string_view module, std::string_view sentence) {
    const std::lock_guard lock(mutex_);
    if (!options_.quiet) printLine("INFO", module, sentence);
}

void TerminalReporter::warn(std::string_view module, std::string_view sentence) {
    const std::lock_guard lock(mutex_);
    ++warnings_;
    printLine("WARN", module, sentence);
}

void TerminalReporter::progress(std::string_view phase, double fraction, double secondsLeft,
                                bool done) {
    const std::lock_guard lock(mutex_);
    if (options_.quiet || options_.progress == ProgressStyle::None) return;
    const double now = options_.elapsedSeconds();
    if (phase != phase_) {
        phase_ = phase;
        phaseBegan_ = now;
        isPhasePrinted_ = false;
    }
    if (isTerminal_) {
        done ? eraseBar() : drawBar(phase, fraction, secondsLeft);
    } else {
        const bool isDue = now - phaseBegan_ >= kShortPhaseSeconds &&
                           (!isPhasePrinted_ || now - lastPrinted_ >= kPrintEverySeconds);
        const bool isJson = options_.progress == ProgressStyle::Json;
        if (isJson && (done || isDue)) {
            printJson(phase, fraction, done ? 0.0 : secondsLeft);
            isPhasePrinted_ = true;
            lastPrinted_ = now;
        } else if (!isJson && (done ? isPhasePrinted_ : isDue)) {
            const std::string left = done ? std::string() : timeLeftText(secondsLeft);
            printLine("PROGRESS", phase,
                      fmt::format("{}%{}{}", percent(fraction), left.empty() ? "" : ", ", left));
            isPhasePrinted_ = true;
            lastPrinted_ = now;
        }
    }
    if (done) phase_.clear();
}

void TerminalReporter::beginFrame(int number, std::size_t position, std::size_t frames) {
    const std::lock_guard lock(mutex_);
    frame_ = {number, position, frames};
}

std::size_t TerminalReporter::warningCount() const {
    const std::lock_guard lock(mutex_);
    return warnings_;
}

void TerminalReporter::requireNoWarnings() const {
    const std::size_t count = warningCount();
    if (count > 0)
        throw Error(ErrorKind::Strict, "--strict",
                    fmt::format("finished, but with {} warning{}", count, count == 1 ? "" : "s"),
                    "mend what they name, or run without --strict");
}

void TerminalReporter::printLine(std::string_view level, std::string_view module,
                                 std::string_view sentence) {
    eraseBar();
    const std::string line = logLine(level, options_.elapsedSeconds(), module, sentence);
    std::fwrite(line.data(), 1, line.size(), options_.stream);
    std::fflush(options_.stream);
}

void TerminalReporter::printJson(std::string_view phase, double fraction, double secondsLeft) {
    JsonValue event = JsonValue::object();
    if (frame_)
        event.set("frame", frame_->number)
            .set("position", static_cast<double>(frame_->position))
            .set("frames", static_cast<double>(frame_->frames));
    event.set("phase", phase).set("fraction", fraction);
    if (secondsLeft >= 0) event.set("secondsLeft", secondsLeft);
    const std::string line = dump(event, -1) + '\n';
    std::fwrite(line.data(), 1, line.size(), options_.stream);
    std::fflush(options_.stream);
}

void TerminalReporter::eraseBar() {
    if (!isBarDrawn_) return;
    std::fputs("\r\x1b[K", options_.stream);
    std::fflush(options_.stream);
    isBarDrawn_ = false;
}

void TerminalReporter::drawBar(std::string_view phase, double fraction, double secondsLeft) {
    constexpr int kWidth = 32;
    const int full = percent(fraction) * kWidth / 100;
    const std::string bar(static_cast<std::size_t>(full), '#');
    const std::string text = fmt::format("\r{:<12} [{:.<{}}] {:3d}%  {}\x1b[K", phase, bar, kWidth,
                                         percent(fraction), timeLeftText(secondsLeft));
    std::fwrite(text.data(), 1, text.size(), options_.stream);
    std::fflush(options_.stream);
    isBarDrawn_ = true;
}

}  // namespace sss
