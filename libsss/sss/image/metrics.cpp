#include "sss/image/metrics.h"

#include "sss/base/error.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <vector>

namespace sss {
namespace {

std::size_t pixelCount(const ImageLayer& layer) {
    return layer.channels.empty() ? 0 : layer.values.size() / layer.channels.size();
}

void requireSameShape(const ImageLayer& picture, const ImageLayer& reference,
                      const ImageLayer* mask) {
    if (picture.channels != reference.channels || picture.values.size() != reference.values.size())
        throw Error(ErrorKind::BadInput, "compare",
                    fmt::format("layer \"{}\" has {} channels and {} pixels, the reference {} and "
                                "{}",
                                picture.name, picture.channels.size(), pixelCount(picture),
                                reference.channels.size(), pixelCount(reference)),
                    "compare pictures of one size with the same layers");
    if (mask && pixelCount(*mask) != pixelCount(picture))
        throw Error(ErrorKind::BadInput, "compare",
                    fmt::format("the mask \"{}\" has {} pixels, the picture {}", mask->name,
                                pixelCount(*mask), pixelCount(picture)),
                    "take the mask from a picture of the same size");
}

std::vector<std::size_t> comparedChannels(const ImageLayer& layer) {
    std::vector<std::size_t> indices;
    for (std::size_t c = 0; c < layer.channels.size(); ++c)
        if (layer.channels[c] != "A") indices.push_back(c);
    return indices;
}

}  // namespace

ImageDifference compareLayers(const ImageLayer& picture, const ImageLayer& reference,
                              const ImageLayer* mask) {
    requireSameShape(picture, reference, mask);
    const std::vector<std::size_t> channels = comparedChannels(picture);
    ImageDifference result;
    double squares = 0, differences = 0, referenceSum = 0, largest = 0;
    for (std::size_t pixel = 0; pixel < pixelCount(picture); ++pixel) {
        if (mask && !(mask->values[pixel * mask->channels.size()] > 0)) continue;
        ++result.pixels;
        for (const std::size_t c : channels) {
            const std::size_t i = pixel * picture.channels.size() + c;
            const double expected = static_cast<double>(reference.values[i]);
            const double difference = static_cast<double>(picture.values[i]) - expected;
            referenceSum += expected;
            differences += difference;
            squares += difference * difference;
            if (!(std::abs(difference) <= largest)) largest = std::abs(difference);
        }
    }
    const double count = static_cast<double>(result.pixels * channels.size());
    if (count == 0) return result;
    result.referenceMean = referenceSum / count;
    if (squares == 0) return result;
    const double mean = std::abs(result.referenceMean);
    result.relativeRmse = std::sqrt(squares / count) / mean;
    result.bias = differences / count / mean;
    result.maximum = std::isnan(squares) ? squares : largest / mean;
    return result;
}

MeanAndError meanOver(std::span<const double> values) {
    const auto count = static_cast<double>(values.size());
    MeanAndError result;
    for (const double v : values) result.mean += v / count;
    double squares = 0;
    for (const double v : values) squares += (v - result.mean) * (v - result.mean);
    result.error = values.size() > 1 ? std::sqrt(squares / (count - 1) / count)
                                     : std::numeric_limits<double>::quiet_NaN();
    return result;
}

}  // namespace sss
