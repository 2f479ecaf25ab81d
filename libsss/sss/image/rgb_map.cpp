#include "sss/image/rgb_map.h"

#include "sss/base/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

namespace sss {
namespace {

std::optional<std::size_t> channelIndex(const ImageLayer& layer, const char* name) {
    const auto found = std::find(layer.channels.begin(), layer.channels.end(), name);
    if (found == layer.channels.end()) return std::nullopt;
    return static_cast<std::size_t>(found - layer.channels.begin());
}

}  // namespace

RgbMap rgbMap(const LayeredImage& image, const std::string& where) {
    const ImageLayer* layer = image.find("");
    if (!layer)
        throw Error(ErrorKind::BadInput, where, "has no plain colour channels",
                    "save it with channels R, G and B, or Y");
    const auto luminance = channelIndex(*layer, "Y");
    const auto red = channelIndex(*layer, "R");
    const auto green = channelIndex(*layer, "G");
    const auto blue = channelIndex(*layer, "B");
    if (!luminance && !(red && green && blue))
        throw Error(ErrorKind::BadInput, where, "has neither channels R, G and B nor channel Y",
                    "save it as RGB or as luminance");

    const bool isRgb = red && green && blue;
    const std::size_t r = isRgb ? *red : *luminance;
    const std::size_t g = isRgb ? *green : r, b = isRgb ? *blue : r;
    RgbMap map{image.width, image.height, {}};
    map.pixels.reserve(image.pixelCount());
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        const float* value = layer->values.data() + pixel * layer->channels.size();
        const Rgb colour{value[r], value[g], value[b]};
        if (!isFinite(colour)) {
            const auto width = static_cast<std::size_t>(image.width);
            throw Error(ErrorKind::BadInput, where,
                        fmt::format("pixel ({}, {}) is not finite", pixel % width, pixel / width),
                        "repair the map: clamp its infinities and remove its NaNs");
        }
        map.pixels.push_back(glm::max(colour, Rgb{0.0f}));
    }
    return map;
}

}  // namespace sss
