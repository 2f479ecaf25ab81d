#pragma once
#include "sss/medium/profile.h"

#include <cstdint>
#include <filesystem>
#include <optional>

struct PreprocessOptions {
    std::filesystem::path scene;
    std::filesystem::path cache;
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
