// Damaged inputs for every reader, the same ones in every run. What finds its way by coverage is
// tests/stress/fuzzing.py; this is what every build can afford.
#include "fuzz/mutations.h"
#include "fuzz/targets.h"
#include "numbers/subjects.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

namespace sss::stress {
namespace {

// A reader that is slower than this for a few kilobytes hangs.
constexpr double kMostSeconds = 10;

struct Share {
    std::string_view target;
    const char* words;  // of tests/stress/fuzz
    std::uint64_t quick, full;
};
// By what one costs; 2 x 10^6 in all. Many more, led by coverage, are fuzzing.py's.
constexpr Share kShares[] = {
    {"scene", "scene.dict", 4000, 300'000}, {"cache", "", 500, 40'000},
    {"exitance", "", 4000, 300'000},        {"obj", "mesh.dict", 4000, 300'000},
    {"ply", "mesh.dict", 4000, 300'000},    {"off", "mesh.dict", 4000, 300'000},
    {"stl", "mesh.dict", 4000, 300'000},    {"exr", "", 1500, 160'000},
};

// The input at hand, for when the reader ends the process.
std::string current;
const char* const kLeft = "sss-stress-found";

void keepCurrent(int signal) {
    const int file = open(kLeft, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file >= 0) {
        [[maybe_unused]] const ssize_t ignored = write(file, current.data(), current.size());
        close(file);
    }
    std::signal(signal, SIG_DFL);
    raise(signal);
}

}  // namespace

void stressMutations(Report& report, Scope scope) {
    const std::filesystem::path corpus = SSS_STRESS_CORPUS;
    const auto old = std::signal(SIGABRT, keepCurrent);
    for (const Share& share : kShares) {
        Row row("corpus", fmt::format("{}: damaged seeds, seconds of the slowest", share.target),
                kMostSeconds);
        const FuzzTarget* const target = findFuzzTarget(share.target);
        const Mutations mutations(
            corpus / share.target,
            *share.words ? corpus.parent_path() / "fuzz" / share.words : std::filesystem::path());
        const std::uint64_t count = scope == Scope::Full ? share.full : share.quick;
        for (std::uint64_t i = 0; i < count; ++i) {
            current = mutations.input(i);
            const auto began = std::chrono::steady_clock::now();
            target->read(std::as_bytes(std::span(current)));
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - began;
            row.add(taken.count(), [&] { return fmt::format("input {}", i); });
        }
        report.add(row);
    }
    std::signal(SIGABRT, old);
}

}  // namespace sss::stress
