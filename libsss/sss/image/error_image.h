#pragma once
#include "sss/image/image.h"
#include "sss/image/png_file.h"

namespace sss {

/// Where a picture differs from a reference, in false colours: a pixel's largest |difference| over
/// the channels but alpha, over the mean of the reference as in ImageDifference, by decades from
/// 0.001 (black) over 0.01 (purple) and 0.1 (orange) to 1 (pale yellow). Grey where the mask's
/// first channel is not > 0; green where a value is NaN. `width` in pixels. Throws Error{BadInput}
/// as compareLayers does.
Picture8 errorImage(const ImageLayer& picture, const ImageLayer& reference, int width,
                    const ImageLayer* mask = nullptr);

}  // namespace sss
