#pragma once
#include "compare_pictures.h"
#include "material_argument.h"
#include "sss/app/terminal_reporter.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

struct RenderOptions {
    std::filesystem::path scene;
    std::filesystem::path cache;  ///< a file, a name with ####, or a folder; empty = in memory
    std::vector<int> frames;      ///< empty: one picture, of frame 1
    std::optional<std::uint64_t> cameraSeed;
    bool cacheOnly = false;
    bool explain = false;
    bool resume = false;
    sss::ProgressStyle progress = sss::ProgressStyle::Automatic;
    bool noKeep = false;  ///< exitance is neither read from beside the cache nor written
    std::filesystem::path output;
    std::filesystem::path stats;
    std::optional<int> samples;
    std::optional<int> width, height;
    std::optional<double> tolerance;
    std::optional<double> metersPerUnit;
    std::optional<std::uint64_t> seed;
    std::uint64_t maxPoints = 20'000'000;
    unsigned threads = 0;  ///< 0 = all cores
    std::optional<std::string> integrator;
    CompareRequest compare;
    ProfileRequest profile;  ///< its boundary holds for the scene's materials, too
    bool listMaterials = false;
    bool noPng = false;
    bool quiet = false;
    bool strict = false;
};

/// Reads the command line. nullopt = --help or --version was printed: leave with 0. Throws
/// sss::Error{Usage}.
std::optional<RenderOptions> readOptions(int argc, const char* const* argv);
