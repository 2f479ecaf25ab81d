#include "sss/image/error_image.h"

#include "sss/base/vec.h"
#include "sss/image/metrics.h"

#include <algorithm>
#include <array>

namespace sss {
namespace {

// Of equal steps in lightness, after matplotlib's inferno at 0, 1/6, ... 1.
constexpr std::array<std::array<double, 3>, 7> kColourMap{{{0, 0, 4},
                                                           {50, 10, 94},
                                                           {120, 28, 109},
                                                           {188, 55, 84},
                                                           {237, 105, 37},
                                                           {251, 180, 26},
                                                           {252, 255, 164}}};
constexpr double kDecades = 3;  // below 1
constexpr std::array<std::uint8_t, 3> kMasked{96, 96, 96}, kBroken{0, 255, 0};

std::array<std::uint8_t, 3> colourOf(double relativeError) {
    if (std::isnan(relativeError)) return kBroken;
    const double place = relativeError > 0 ? 1 + std::log10(relativeError) / kDecades : 0.0;
    const double at = std::clamp(place, 0.0, 1.0) * (kColourMap.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(at), kColourMap.size() - 2);
    const double share = at - static_cast<double>(below);
    std::array<std::uint8_t, 3> colour;
    for (std::size_t c = 0; c < 3; ++c)
        colour[c] = static_cast<std::uint8_t>(
            std::lround(kColourMap[below][c] * (1 - share) + kColourMap[below + 1][c] * share));
    return colour;
}

}  // namespace

Picture8 errorImage(const ImageLayer& picture, const ImageLayer& reference, int width,
                    const ImageLayer* mask) {
    const double mean = compareLayers(picture, reference, mask).referenceMean;
    const std::size_t channels = picture.channels.size();
    const std::size_t pixels = channels > 0 ? picture.values.size() / channels : 0;
    Picture8 image;
    image.width = width;
    image.height = static_cast<int>(pixels / static_cast<std::size_t>(width));
    for (std::size_t p = 0; p < pixels; ++p) {
        double largest = 0;
        for (std::size_t c = 0; c < channels; ++c) {
            if (picture.channels[c] == "A") continue;
            const std::size_t i = p * channels + c;
            const double difference = std::abs(static_cast<double>(picture.values[i]) -
                                               static_cast<double>(reference.values[i]));
            if (!(difference <= largest)) largest = difference;
            if (std::isnan(largest)) break;
        }
        const bool isMasked = mask && !(mask->values[p * mask->channels.size()] > 0);
        const auto colour =
            isMasked ? kMasked : colourOf(largest == 0 ? 0.0 : largest / std::abs(mean));
        image.values.insert(image.values.end(), colour.begin(), colour.end());
    }
    return image;
}

}  // namespace sss
