#include "sss/app/common_options.h"

#include "sss/base/error.h"
#include "sss/base/frame_list.h"
#include "sss/scene/material_override.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cmath>

namespace sss {
namespace {

constexpr unsigned kMostThreads = 1024;
constexpr double kLargestTolerance = 0.5;

void add(CLI::App& app, CommonOptions& o) {
    using Text = std::string;
    app.add_option("scene", o.scene);
    app.add_option("--stats", o.stats);
    app.add_option_function<Text>(
        "--frames", [&o](const Text& text) { o.frames = parseFrames(text, "--frames"); });
    app.add_option_function<Text>(
        "--progress", [&o](const Text& text) { o.progress = progressStyle(text, "--progress"); });
    app.add_option_function<Text>(
        "--boundary", [&o](const Text& text) { o.boundary = boundaryModel(text, "--boundary"); });
    app.add_option("--model", o.model);
    app.add_option("--tolerance", o.tolerance);
    app.add_option("--meters-per-unit", o.metersPerUnit);
    app.add_option("--seed", o.seed)->check(CLI::NonNegativeNumber);
    app.add_option("--max-points", o.maxPoints)->check(CLI::NonNegativeNumber);
    app.add_option("--threads", o.threads)->check(CLI::NonNegativeNumber);
    app.add_flag("--explain", o.explain);
    app.add_flag("--quiet", o.quiet);
    app.add_flag("--strict", o.strict);
}

void check(const ProgramText& program, const CommonOptions& o) {
    if (o.tolerance && !(*o.tolerance > 0 && *o.tolerance <= kLargestTolerance))
        usageError(program, "--tolerance",
                   fmt::format("{} is not in (0, {}]", *o.tolerance, kLargestTolerance));
    requireLength(program, "--meters-per-unit", o.metersPerUnit);
    if (o.maxPoints == 0) usageError(program, "--max-points", "must be at least 1");
    if (o.threads > kMostThreads)
        usageError(program, "--threads",
                   fmt::format("{} is more than {}", o.threads, kMostThreads));
}

}  // namespace

void CommonOptions::applyTo(Scene& target) const {
    if (tolerance) target.quality.tolerance = *tolerance;
    if (seed) target.quality.seed = *seed;
    if (!model.empty()) setModel(target, model, "--model");
    if (boundary) setBoundary(target, *boundary);
}

void usageError(const ProgramText& program, const std::string& where, const std::string& what) {
    throw Error(ErrorKind::Usage, where, what, fmt::format("see {} --help", program.name));
}

void requireLength(const ProgramText& program, const std::string& where,
                   const std::optional<double>& value) {
    if (value && !(*value > 0 && std::isfinite(*value)))
        usageError(program, where, fmt::format("{} is not a positive length", *value));
}

void requireNameForEach(const ProgramText& program, const std::filesystem::path& output,
                        const std::vector<int>& frames, const std::string& instead) {
    if (frames.size() < 2 || hasFrameField(output.string())) return;
    usageError(
        program, "--output",
        fmt::format("{} would hold the last of {} frames only: give the number a place "
                    "(####){}{}",
                    output.string(), frames.size(), instead.empty() ? "" : ", or ", instead));
}

bool readCommandLine(CLI::App& app, CommonOptions& options, const ProgramText& program, int argc,
                     const char* const* argv) {
    bool help = false, version = false;
    app.set_help_flag();
    app.add_flag("-h,--help", help);
    app.add_flag("--version", version);
    add(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        usageError(program, "command line", e.what());
    }
    if (help)
        fmt::print(fmt::runtime(program.help), SSS_VERSION);
    else if (version)
        fmt::print("{} {}\n", program.name, SSS_VERSION);
    else
        check(program, options);
    return !help && !version;
}

}  // namespace sss
