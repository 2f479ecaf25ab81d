#pragma once
#include "sss/app/terminal_reporter.h"
#include "sss/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
}

namespace sss {

/// What both programs are told on their command lines, by the same names.
struct CommonOptions {
    std::filesystem::path scene;
    std::filesystem::path stats;
    std::vector<int> frames;  ///< empty: frame 1 alone
    std::optional<double> tolerance;
    std::optional<double> metersPerUnit;
    std::optional<std::uint64_t> seed;
    std::optional<BoundaryModel> boundary;
    std::string model;  ///< of diffusion; empty = the scene's
    std::uint64_t maxPoints = 20'000'000;
    unsigned threads = 0;  ///< 0 = all cores
    ProgressStyle progress = ProgressStyle::Automatic;
    bool explain = false;
    bool quiet = false;
    bool strict = false;

    /// The scene with what the command line says instead. Throws Error{Usage}.
    void applyTo(Scene& target) const;
};

/// A program as its command line knows it: "sss-render", and its whole help with {} for the
/// version.
struct ProgramText {
    const char* name;
    const char* help;
};

/// Throws Error{Usage}: `what` is wrong with `where`, and where to read more.
[[noreturn]] void usageError(const ProgramText& program, const std::string& where,
                             const std::string& what);

/// Adds the options above to a program's own, which `app` holds already, and reads the command
/// line. False: --help or --version was printed, leave with 0. Throws Error{Usage}, also for values
/// that are out of range.
bool readCommandLine(CLI::App& app, CommonOptions& options, const ProgramText& program, int argc,
                     const char* const* argv);

/// Throws Error{Usage} unless `value` is missing or a positive number.
void requireLength(const ProgramText& program, const std::string& where,
                   const std::optional<double>& value);

/// Throws Error{Usage} if several frames would be written over each other at `output`, a name
/// without a place for their numbers. `instead` says what else to give: "name a folder (DIR/)".
void requireNameForEach(const ProgramText& program, const std::filesystem::path& output,
                        const std::vector<int>& frames, const std::string& instead = {});

}  // namespace sss
