#include "compare_pictures.h"

#include "channel_names.h"
#include "sss/base/error.h"
#include "sss/base/json.h"
#include "sss/base/near_name.h"
#include "sss/image/error_image.h"
#include "sss/image/exr_file.h"
#include "sss/image/flip.h"
#include "sss/image/metrics.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace {

using namespace sss;

const ImageLayer& layerOf(const LayeredImage& image, const std::string& file,
                          const std::string& name) {
    if (const ImageLayer* layer = image.find(name)) return *layer;
    std::vector<std::string_view> names;
    for (const ImageLayer& layer : image.layers)
        if (!layer.name.empty()) names.push_back(layer.name);
    throw Error(ErrorKind::BadInput, file,
                name.empty() ? std::string("has no R, G, B")
                             : fmt::format("has no layer called {}", inQuotes(name)),
                names.empty() ? "it has no named layers" : nameHint(name, names));
}

// A layer of the reference; A is the alpha of its beauty.
ImageLayer maskOf(const LayeredImage& image, const std::string& file, const std::string& name) {
    if (name != "A" || image.find(name)) return layerOf(image, file, name);
    const ImageLayer& beauty = layerOf(image, file, "");
    const auto alpha = std::ranges::find(beauty.channels, "A");
    if (alpha == beauty.channels.end())
        throw Error(ErrorKind::BadInput, file, "has no alpha to be the mask");
    ImageLayer mask{"A", {"A"}, {}, false};
    const auto first = static_cast<std::size_t>(alpha - beauty.channels.begin());
    for (std::size_t i = first; i < beauty.values.size(); i += beauty.channels.size())
        mask.values.push_back(beauty.values[i]);
    return mask;
}

// One figure by picture.
struct Figure {
    const char *name, *key;
    std::vector<double> values;
};
struct Comparison {
    std::size_t pixels = 0;
    double referenceMean = 0;
    std::vector<Figure> figures;

    void add(const char* name, const char* key, double value) {
        const auto found = std::ranges::find(figures, std::string_view(key), &Figure::key);
        if (found != figures.end())
            found->values.push_back(value);
        else
            figures.push_back({name, key, {value}});
    }
};

bool isColour(const ImageLayer& layer) {
    return layer.channels.size() >= kChannelNames.size() &&
           std::equal(kChannelNames.begin(), kChannelNames.end(), layer.channels.begin());
}

// JSON has no numbers that are not finite.
JsonValue jsonNumber(double value) { return std::isfinite(value) ? JsonValue(value) : JsonValue(); }

void printJson(const Comparison& comparison, const CompareRequest& request) {
    JsonValue out = JsonValue::object();
    out.set("layer", request.layer)
        .set("pictures", request.files.size() - 1)
        .set("pixels", comparison.pixels)
        .set("referenceMean", jsonNumber(comparison.referenceMean));
    for (const Figure& figure : comparison.figures) {
        const MeanAndError e = meanOver(figure.values);
        JsonValue entry = JsonValue::object();
        entry.set("mean", jsonNumber(e.mean)).set("standardError", jsonNumber(e.error));
        out.set(figure.key, entry);
    }
    fmt::print("{}\n", dump(out));
}

void printText(const Comparison& comparison, const CompareRequest& request) {
    fmt::print("{}: {} pixels, mean of the reference {:.6g}\n",
               request.layer.empty() ? "beauty" : request.layer, comparison.pixels,
               comparison.referenceMean);
    for (const Figure& figure : comparison.figures) {
        const MeanAndError e = meanOver(figure.values);
        fmt::print("{:<14}{:>12.6g}", figure.name, e.mean);
        if (figure.values.size() > 1) fmt::print("  +- {:.2g}", e.error);
        fmt::print("\n");
    }
}

}  // namespace

void comparePictures(const CompareRequest& request) {
    const std::string referenceFile = request.files.back().string();
    const LayeredImage reference = readExr(referenceFile);
    const ImageLayer& expected = layerOf(reference, referenceFile, request.layer);
    ImageLayer mask;
    if (!request.mask.empty()) mask = maskOf(reference, referenceFile, request.mask);
    const ImageLayer* masked = request.mask.empty() ? nullptr : &mask;

    Comparison comparison;
    for (std::size_t k = 0; k + 1 < request.files.size(); ++k) {
        const std::string file = request.files[k].string();
        const LayeredImage image = readExr(file);
        if (image.width != reference.width || image.height != reference.height)
            throw Error(ErrorKind::BadInput, file,
                        fmt::format("is {} x {} pixels, the reference {} x {}", image.width,
                                    image.height, reference.width, reference.height),
                        "compare pictures of one size");
        const ImageLayer& layer = layerOf(image, file, request.layer);
        const ImageDifference difference = compareLayers(layer, expected, masked);
        comparison.pixels = difference.pixels;
        comparison.referenceMean = difference.referenceMean;
        comparison.add("relative RMSE", "relativeRmse", difference.relativeRmse);
        comparison.add("bias", "bias", difference.bias);
        comparison.add("maximum", "maximum", difference.maximum);
        if (isColour(layer))
            comparison.add("FLIP", "flip", meanFlip(layer, expected, image.width, masked));
        if (k == 0 && !request.errorImage.empty())
            writePng(request.errorImage, errorImage(layer, expected, image.width, masked));
    }
    if (request.json)
        printJson(comparison, request);
    else
        printText(comparison, request);
}
