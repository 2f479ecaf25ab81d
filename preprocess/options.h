#pragma once
#include "sss/app/common_options.h"

#include <filesystem>
#include <optional>

struct PreprocessOptions : sss::CommonOptions {
    std::filesystem::path cache;  ///< a file, a name with ####, or a folder
    bool printEstimate = false;
    std::filesystem::path info;  ///< --info: describe this cache and do nothing else
    std::filesystem::path exportPly;
    std::optional<double> spacingMm;
    bool json = false;
};

/// Reads the command line. nullopt = --help or --version was printed: leave with 0. Throws
/// sss::Error{Usage}.
std::optional<PreprocessOptions> readOptions(int argc, const char* const* argv);
