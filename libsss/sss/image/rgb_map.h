#pragma once
#include "sss/base/vec.h"
#include "sss/image/image.h"

#include <string>
#include <vector>

namespace sss {

/// Plain scene-linear colours, row by row from the top left.
struct RgbMap {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;
};

/// The colours of the unnamed layer (R, G, B, or luminance Y for all three). Negative values, which
/// filters leave behind, become 0. Throws Error{BadInput} at `where` if there is no such layer or a
/// pixel is not finite.
RgbMap rgbMap(const LayeredImage& image, const std::string& where);

}  // namespace sss
