#include "sss/app/program.h"

#include "sss/base/atomic_file.h"
#include "sss/base/error.h"
#include "support/temporary_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>

// Each case runs in a child process, as a main would.
namespace sss {
namespace {

using ::testing::ExitedWithCode;

// _Exit: the leak checker must not look at the threads that the fork left behind.
[[noreturn]] void runAndExit(const std::function<int()>& body) {
    const char* const arguments[] = {"sss-test", nullptr};
    std::_Exit(
        runProgram("sss-test", 1, arguments, [&](int, const char* const*) { return body(); }));
}

TEST(ProgramTest, PassesTheBodysCode) {
    EXPECT_EXIT(runAndExit([] { return 0; }), ExitedWithCode(0), "^$");
    EXPECT_EXIT(runAndExit([] { return 6; }), ExitedWithCode(6), "^$");
}

TEST(ProgramTest, PassesTheArguments) {
    const char* const arguments[] = {"sss-test", "--quiet", nullptr};
    const int code = runProgram("sss-test", 2, arguments, [](int argc, const char* const* argv) {
        return argc == 2 && std::string(argv[1]) == "--quiet" ? 42 : 1;
    });
    EXPECT_EQ(code, 42);
}

TEST(ProgramTest, ErrorsBecomeALineAndTheirCode) {
    for (const ErrorKind kind : {ErrorKind::Internal, ErrorKind::Usage, ErrorKind::BadInput,
                                 ErrorKind::Io, ErrorKind::Resource, ErrorKind::Strict})
        EXPECT_EXIT(
            runAndExit([&]() -> int { throw Error(kind, "a.json:1:2", "is wrong", "mend it"); }),
            ExitedWithCode(static_cast<int>(kind)),
            "^ERROR +[0-9.]+s sss-test a.json:1:2: is wrong; mend it\n$");
}

TEST(ProgramTest, OutOfMemoryIsFive) {
    EXPECT_EXIT(runAndExit([]() -> int { throw std::bad_alloc(); }), ExitedWithCode(5),
                "^ERROR .*out of memory");
}

TEST(ProgramTest, AnythingElseIsInternal) {
    EXPECT_EXIT(runAndExit([]() -> int { throw std::runtime_error("odd"); }), ExitedWithCode(1),
                "^ERROR .*internal error: odd");
    EXPECT_EXIT(runAndExit([]() -> int { throw 5; }), ExitedWithCode(1), "^ERROR .*internal error");
    EXPECT_EXIT(runAndExit([]() -> int {
                    std::filesystem::create_directory("/no-such-folder/x");
                    return 0;
                }),
                ExitedWithCode(4), "^ERROR .*no-such-folder");
}

TEST(ProgramTest, SignalsEndItWithoutTemporaryFiles) {
    const testing::TemporaryFolder folder;
    testing::writeFile(folder / "old", "whole");
    for (const int number : {SIGHUP, SIGINT, SIGTERM}) {
        std::signal(number, SIG_DFL);
        EXPECT_EXIT(runAndExit([&] {
                        AtomicFile first(folder / "old"), second(folder / "new");
                        first.append("half");
                        { const AtomicFile gone(folder / "gone"); }
                        const AtomicFile third(folder / "third");
                        if (folder.fileCount() != 4) return 1;
                        std::raise(number);
                        return 0;
                    }),
                    ExitedWithCode(128 + number), "^ERROR interrupted");
        EXPECT_EQ(folder.fileCount(), 1u);
        EXPECT_EQ(testing::readFile(folder / "old"), "whole");
    }
}

TEST(ProgramTest, IgnoredSignalsStayIgnored) {
    EXPECT_EXIT(
        {
            std::signal(SIGHUP, SIG_IGN);
            runAndExit([] {
                std::raise(SIGHUP);
                return 0;
            });
        },
        ExitedWithCode(0), "^$");
}

void pointStdoutAt(int descriptor) {
    if (dup2(descriptor, STDOUT_FILENO) < 0) std::abort();
}

TEST(ProgramTest, FullStandardOutputIsAnError) {
    EXPECT_EXIT(
        {
            pointStdoutAt(open("/dev/full", O_WRONLY));
            runAndExit([] {
                std::puts("result");
                return 0;
            });
        },
        ExitedWithCode(4), "standard output: cannot write: No space left");
}

TEST(ProgramTest, AReaderThatHasLeftIsFine) {
    EXPECT_EXIT(
        {
            int ends[2];
            if (pipe(ends) != 0) std::abort();
            close(ends[0]);
            pointStdoutAt(ends[1]);
            runAndExit([] {
                std::puts("result");
                return 0;
            });
        },
        ExitedWithCode(0), "^$");
}

}  // namespace
}  // namespace sss
