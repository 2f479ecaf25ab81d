#pragma once
#include "sss/base/vec.h"
#include "sss/image/image.h"
#include "sss/image/png_file.h"

namespace sss {

/// Scene-linear colour to display-linear in [0, 1]: what lies below 0.8 stays as it is; above, a
/// smooth shoulder (rational, continuous slope) approaches 1. It acts on the largest channel and
/// keeps the ratios of the others, so hues stay; far over the top, colours drift towards white at
/// constant hue. Never decreasing in exposure, channel by channel. Negative values and NaN count
/// as 0.
Rgb toneMapped(const Rgb& sceneLinear);

/// Display-linear value in [0, 1] to its sRGB code value in [0, 1] (IEC 61966-2-1).
float srgbEncoded(float linear);

/// The unnamed layer (R, G, B first; alpha is left out) as an 8-bit sRGB picture, brightened by
/// `exposureStops`. A fixed dither of less than one code value, the same for the three channels,
/// breaks up bands; black stays 0.
Picture8 toneMap(const LayeredImage& image, double exposureStops);

}  // namespace sss
