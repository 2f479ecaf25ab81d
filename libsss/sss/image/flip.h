#pragma once
#include "sss/image/image.h"

#include <vector>

namespace sss {

/// How much a viewer who flips between two pictures sees them differ, pixel by pixel in [0, 1]: LDR
/// FLIP [Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"] at its
/// default of 67.02 pixels a degree (a 0.7 m wide 4K screen seen from 0.7 m). Colours (the first
/// three channels, linear Rec.709) are clamped to [0, 1]. Both layers of one size, `width` pixels.
std::vector<double> flipMap(const ImageLayer& picture, const ImageLayer& reference, int width);

/// Mean FLIP over the pixels where `mask`'s first channel is > 0 (nullptr = everywhere) of two
/// scene-linear layers, shown tone-mapped as a PNG of ours is, at the exposure that makes the
/// reference's mean there 0.18. 0 where nothing is compared; NaN if a value is.
double meanFlip(const ImageLayer& picture, const ImageLayer& reference, int width,
                const ImageLayer* mask = nullptr);

}  // namespace sss
