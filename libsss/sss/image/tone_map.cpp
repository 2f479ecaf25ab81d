#include "sss/image/tone_map.h"

#include "sss/base/error.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

constexpr float kShoulder = 0.8f;        // values up to here pass unchanged
constexpr float kWhitePerExcess = 0.1f;  // how soon overexposed colours drift to white

float compressed(float value) {
    if (value <= kShoulder) return value;
    const float excess = (value - kShoulder) / (1.0f - kShoulder);
    return kShoulder + (1.0f - kShoulder) * (excess / (1.0f + excess));
}

float positive(float value) { return value > 0.0f ? std::min(value, 1e30f) : 0.0f; }

/// In (0, 1): the additive recurrence of the plastic number in two dimensions (R2, M. Roberts
/// 2018), in integers so that it is the same everywhere; evenly spread, without visible pattern.
float dither(std::uint32_t x, std::uint32_t y) {
    const std::uint32_t bits = (x + 1) * 0xc13fa9a9u + (y + 1) * 0x91e10da5u;
    return (static_cast<float>(bits >> 16) + 0.5f) * 0x1p-16f;
}

std::uint8_t codeValue(float displayLinear, float threshold) {
    const float code = srgbEncoded(displayLinear) * 255.0f + threshold;
    return static_cast<std::uint8_t>(std::min(code, 255.0f));
}

}  // namespace

Rgb toneMapped(const Rgb& sceneLinear) {
    const Rgb colour{positive(sceneLinear.x), positive(sceneLinear.y), positive(sceneLinear.z)};
    const float peak = maxComponent(colour);
    if (peak <= kShoulder) return colour;
    const float shown = compressed(peak);
    const float excess = kWhitePerExcess * (peak - shown);
    const float white = excess / (1.0f + excess);
    return shown * (colour / peak * (1.0f - white) + Rgb{white});
}

float srgbEncoded(float linear) {
    if (linear <= 0.0031308f) return 12.92f * linear;
    return 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

Picture8 toneMap(const LayeredImage& image, double exposureStops) {
    const ImageLayer* layer = image.find("");
    if (!layer || layer->channels.size() < 3)
        throw Error(ErrorKind::Internal, "image", "there is no colour layer to tone-map");
    const auto gain = static_cast<float>(std::exp2(exposureStops));
    const std::size_t stride = layer->channels.size();
    Picture8 picture{image.width, image.height, 3, {}};
    picture.values.reserve(image.pixelCount() * 3);
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        const float* value = layer->values.data() + pixel * stride;
        const Rgb shown = toneMapped(gain * Rgb{value[0], value[1], value[2]});
        const auto width = static_cast<std::size_t>(image.width);
        const float threshold = dither(static_cast<std::uint32_t>(pixel % width),
                                       static_cast<std::uint32_t>(pixel / width));
        for (const float channel : {shown.x, shown.y, shown.z})
            picture.values.push_back(codeValue(channel, threshold));
    }
    return picture;
}

}  // namespace sss
