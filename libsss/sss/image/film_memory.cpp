#include "sss/image/film_memory.h"

#include "sss/base/require_memory.h"
#include "sss/image/film.h"

#include <fmt/core.h>

#include <algorithm>

namespace sss {

void requireFilmMemory(int width, int height, const std::vector<std::string>& layers) {
    // A channel as it grows, and as the file wants it: whole, or half as precise.
    constexpr std::uint64_t kFull = 2 * sizeof(float), kHalf = sizeof(float) + sizeof(float) / 2;
    constexpr std::uint64_t kBeautyChannels = 4;
    std::uint64_t bytesPerPixel = kBeautyChannels * kHalf;
    for (const FilmLayer& layer : filmLayers())
        if (std::ranges::find(layers, layer.name) != layers.end())
            bytesPerPixel += layer.channels.size() * (layer.fullPrecision ? kFull : kHalf);
    requireMemory(
        "film",
        fmt::format("a picture of {} x {} pixels in {} layers", width, height, layers.size() + 1),
        static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * bytesPerPixel,
        "make \"width\" and \"height\" smaller, or ask for fewer \"layers\"");
}

}  // namespace sss
