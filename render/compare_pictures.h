#pragma once
#include <filesystem>
#include <string>
#include <vector>

/// What `sss-render --compare` was asked for.
struct CompareRequest {
    /// The pictures, of independent seeds if several, and last the reference; empty = not asked.
    std::vector<std::filesystem::path> files;
    std::string layer;                 ///< empty = beauty
    std::string mask;                  ///< a layer of the reference, or A; empty = everywhere
    std::filesystem::path errorImage;  ///< PNG; empty = none
    bool json = false;
};

/// Prints how far the pictures are from the reference to stdout, with standard errors if there are
/// several; the error image is of the first. Throws sss::Error.
void comparePictures(const CompareRequest& request);
