#include "sss/app/program.h"

#include "sss/app/log_line.h"
#include "sss/base/atomic_file.h"
#include "sss/base/error.h"
#include "sss/base/stopwatch.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string_view>

namespace sss {
namespace {

// Whether a progress bar may stand on the line; asked before any signal, where it is safe to ask.
volatile std::sig_atomic_t stderrIsTerminal = 0;

// Only async-signal-safe calls: no formatting, no locks, no destructors.
void handleInterrupt(int signal) {
    removeTemporaryFiles();
    constexpr std::string_view kText =
        "\nERROR interrupted; files that were not finished are removed\n";
    const std::string_view text = stderrIsTerminal ? kText : kText.substr(1);
    [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, text.data(), text.size());
    _exit(128 + signal);
}

void installSignalHandlers() {
    stderrIsTerminal = isatty(STDERR_FILENO);
    // A full disk and a reader that has left are reported by write(), with a sentence.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int number : {SIGHUP, SIGINT, SIGTERM}) {
        struct sigaction old {};
        sigaction(number, nullptr, &old);
        if (old.sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = handleInterrupt;
        sigfillset(&action.sa_mask);
        sigaction(number, &action, nullptr);
    }
}

void flushOutput() {
    errno = 0;
    const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (failed && errno != EPIPE)
        throw Error(ErrorKind::Io, "standard output",
                    fmt::format("cannot write: {}", std::strerror(errno)));
}

}  // namespace

int runProgram(const char* name, int argc, const char* const* argv, const ProgramBody& body) {
    const Stopwatch sinceStart;
    installSignalHandlers();
    const auto fail = [&](ErrorKind kind, std::string_view sentence) {
        const std::string line = logLine("ERROR", sinceStart.seconds(), name, sentence);
        std::fwrite(line.data(), 1, line.size(), stderr);
        return static_cast<int>(kind);
    };
    try {
        const int code = body(argc, argv);
        flushOutput();
        return code;
    } catch (const Error& error) {
        return fail(error.kind(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::Resource,
                    "out of memory; use fewer points (a larger --spacing) or a smaller picture");
    } catch (const std::filesystem::filesystem_error& error) {
        return fail(ErrorKind::Io, error.what());
    } catch (const std::exception& error) {
        return fail(ErrorKind::Internal, fmt::format("internal error: {}", error.what()));
    } catch (...) {
        return fail(ErrorKind::Internal, "internal error of unknown kind");
    }
}

}  // namespace sss
