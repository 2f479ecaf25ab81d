#pragma once
#include "sss/app/terminal_reporter.h"
#include "sss/medium/profile.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

struct PreprocessOptions {
    std::filesystem::path scene;
    std::filesystem::path cache;  ///< a file, a name with ####, or a folder
    std::vector<int> frames;      ///< empty: frame 1 alone
    bool explain = false;
    bool printEstimate = false;
    sss::ProgressStyle progress = sss::ProgressStyle::Automatic;
    std::filesystem::path info;  ///< --info: describe this cache and do nothing else
    std::filesystem::path exportPly;
    std::filesystem::path stats;
    std::optional<double> spacingMm;
    std::optional<double> tolerance;
    std::optional<double> metersPerUnit;
    std::optional<sss::BoundaryModel> boundary;
    std::string model;  ///< of diffusion; empty = the scene's
    std::optional<std::uint64_t> seed;
    std::uint64_t maxPoints = 20'000'000;
    unsigned threads = 0;  ///< 0 = all cores
    bool json = false;
    bool quiet = false;
    bool strict = false;
};

/// Reads the command line. nullopt = --help or --version was printed: leave with 0. Throws
/// sss::Error{Usage}.
std::optional<PreprocessOptions> readOptions(int argc, const char* const* argv);
