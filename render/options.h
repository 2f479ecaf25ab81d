#pragma once
#include "compare_pictures.h"
#include "material_argument.h"
#include "sss/app/common_options.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

struct RenderOptions : sss::CommonOptions {
    std::filesystem::path cache;  ///< a file, a name with ####, or a folder; empty = in memory
    std::optional<std::uint64_t> cameraSeed;
    bool cacheOnly = false;
    bool resume = false;
    bool noKeep = false;  ///< exitance is neither read from beside the cache nor written
    std::filesystem::path output;
    std::optional<int> samples;
    std::optional<int> width, height;
    std::optional<std::string> integrator;
    CompareRequest compare;
    ProfileRequest profile;  ///< its model and boundary are those above
    bool listMaterials = false;
    bool noPng = false;
};

/// Reads the command line. nullopt = --help or --version was printed: leave with 0. Throws
/// sss::Error{Usage}.
std::optional<RenderOptions> readOptions(int argc, const char* const* argv);
