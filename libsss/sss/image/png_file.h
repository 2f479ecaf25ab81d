#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace sss {

/// An 8-bit sRGB picture, row by row from the top left, channels interleaved.
struct Picture8 {
    int width = 0, height = 0;
    int channels = 3;  ///< 3 = RGB, 4 = RGB with straight alpha
    std::vector<std::uint8_t> values;
};

/// Throws Error{Io}, and then no file is left or changed; Error{Internal} if the sizes disagree.
void writePng(const std::filesystem::path& path, const Picture8& picture);

/// Any PNG as RGB, or RGBA if it has transparency. Throws Error{Io} for a missing file, and
/// Error{BadInput} for one that is no PNG, is damaged or over 2^28 pixels.
Picture8 readPng(const std::filesystem::path& path);

/// Whether it is a PNG file that is there to its last byte: signature, every chunk's checksum, and
/// an end after which nothing comes. False for a missing file, too; pixels are not decoded. Throws
/// Error{Io} for a file that may not be read.
bool isWholePng(const std::filesystem::path& path);

}  // namespace sss
