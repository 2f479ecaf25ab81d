#include "sss/app/terminal_reporter.h"

#include "sss/app/log_line.h"
#include "sss/base/error.h"

#include <gtest/gtest.h>

#include <string>

namespace sss {
namespace {

class TerminalReporterTest : public ::testing::Test {
protected:
    ~TerminalReporterTest() override { std::fclose(stream_); }

    TerminalOptions options(bool isTerminal) {
        return {false, stream_, isTerminal, [this] { return now; }};
    }
    /// All that was printed so far.
    std::string printed() {
        std::fflush(stream_);
        std::string text(static_cast<std::size_t>(std::ftell(stream_)), '\0');
        std::rewind(stream_);
        const std::size_t size = std::fread(text.data(), 1, text.size(), stream_);
        std::fseek(stream_, 0, SEEK_END);
        return text.substr(0, size);
    }
    double now = 0;

private:
    std::FILE* stream_ = std::tmpfile();
};

TEST(LogLine, HasTheDocumentedColumns) {
    EXPECT_EQ(logLine("INFO", 0.02, "scene", "sentence"), "INFO     0.02s scene   sentence\n");
    EXPECT_EQ(logLine("INFO", 29.8, "cache", "wrote"), "INFO    29.80s cache   wrote\n");
    EXPECT_EQ(logLine("WARN", 0.31, "mesh", "open"), "WARN     0.31s mesh    open\n");
    EXPECT_EQ(logLine("PROGRESS", 12.1, "irradiance", "42%"), "PROGRESS 12.1s irradiance 42%\n");
    EXPECT_EQ(logLine("PROGRESS", 1234, "points", "42%"), "PROGRESS 1234.0s points  42%\n");
    EXPECT_EQ(logLine("ERROR", 1, "x", "two\nlines"), "ERROR    1.00s x       two lines\n");
}

TEST(TimeLeftText, ChoosesTheUnit) {
    EXPECT_EQ(timeLeftText(-1), "");
    EXPECT_EQ(timeLeftText(16.6), "17 s left");
    EXPECT_EQ(timeLeftText(180), "3 min left");
    EXPECT_EQ(timeLeftText(7560), "2.1 h left");
}

TEST_F(TerminalReporterTest, LinesCarryLevelTimeAndModule) {
    TerminalReporter reporter(options(false));
    now = 1.5;
    reporter.info("scene", "1 mesh");
    reporter.warn("mesh", "3 open boundaries");
    EXPECT_EQ(printed(),
              "INFO     1.50s scene   1 mesh\nWARN     1.50s mesh    3 open boundaries\n");
    EXPECT_EQ(reporter.warningCount(), 1u);
}

TEST_F(TerminalReporterTest, QuietLeavesOnlyWarnings) {
    TerminalOptions quiet = options(false);
    quiet.quiet = true;
    TerminalReporter reporter(quiet);
    reporter.info("scene", "1 mesh");
    reporter.progress("points", 0.1, 9, false);
    now = 50;
    reporter.progress("points", 0.5, 9, false);
    reporter.warn("mesh", "open");
    EXPECT_EQ(printed(), "WARN    50.00s mesh    open\n");
}

TEST_F(TerminalReporterTest, PlainProgressComesEveryTwoSeconds) {
    TerminalReporter reporter(options(false));
    for (int tenth = 0; tenth <= 50; ++tenth) {
        now = tenth * 0.1;
        reporter.progress("points", tenth / 50.0, 5 - now, false);
    }
    now = 5.1;
    reporter.progress("points", 1, 0, true);
    EXPECT_EQ(printed(),
              "PROGRESS  1.0s points  20%, 4 s left\n"
              "PROGRESS  3.0s points  60%, 2 s left\n"
              "PROGRESS  5.0s points  100%, 0 s left\n"
              "PROGRESS  5.1s points  100%\n");
}

TEST_F(TerminalReporterTest, ShortPhasesPrintNoProgress) {
    TerminalReporter reporter(options(false));
    for (int phase = 0; phase < 20; ++phase) {
        reporter.progress("tile", 0.5, 0.4, false);
        now += 0.9;
        reporter.progress("tile", 0.9, 0.1, false);
        reporter.progress("tile", 1, 0, true);
    }
    EXPECT_EQ(printed(), "");
}

TEST_F(TerminalReporterTest, ABarIsErasedBeforeALineAndAtTheEnd) {
    {
        TerminalReporter reporter(options(true));
        reporter.progress("points", 0.5, 17, false);
        EXPECT_EQ(printed(),
                  "\rpoints       [################................]  50%  17 s left\x1b[K");
        reporter.info("scene", "1 mesh");
        reporter.progress("points", 0.75, 8, false);
    }
    const std::string text = printed();
    EXPECT_NE(text.find("\r\x1b[KINFO     0.00s scene   1 mesh\n"), std::string::npos);
    EXPECT_EQ(text.substr(text.size() - 4), "\r\x1b[K");
}

TEST_F(TerminalReporterTest, PlainOutputHasNoControlCharacters) {
    TerminalReporter reporter(options(false));
    now = 3;
    reporter.progress("points", 0.5, 17, false);
    now = 9;
    reporter.progress("points", 0.6, 17, false);
    reporter.info("scene", "1 mesh");
    for (const char c : printed()) EXPECT_TRUE(c == '\n' || (c >= ' ' && c < '\x7f'));
}

TEST_F(TerminalReporterTest, StrictCountsWarnings) {
    TerminalReporter reporter(options(false));
    reporter.info("scene", "fine");
    EXPECT_NO_THROW(reporter.requireNoWarnings());
    reporter.warn("mesh", "open");
    reporter.warn("mesh", "flipped");
    try {
        reporter.requireNoWarnings();
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.exitCode(), 6);
        EXPECT_NE(std::string(error.what()).find("2 warnings"), std::string::npos);
    }
}

}  // namespace
}  // namespace sss
