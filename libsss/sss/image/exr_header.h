#pragma once
#include <cstddef>
#include <filesystem>
#include <span>

namespace sss {

/// What a picture's first header states, read without believing it.
struct ExrHeader {
    int width = 0, height = 0;  ///< of the data window
    std::size_t channels = 0;
};

/// Walks the headers of an OpenEXR file (all parts) before OpenEXR does, which allocates what an
/// attribute's size says. Throws Error{Io} if the file cannot be opened, and Error{BadInput} if it
/// is no OpenEXR file, ends within a header, or has an attribute larger than itself, no data window
/// or no channels.
ExrHeader checkExrHeaders(const std::filesystem::path& path);

}  // namespace sss
