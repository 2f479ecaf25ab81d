#include "compare_pictures.h"

#include "sss/base/error.h"
#include "sss/base/json.h"
#include "sss/base/near_name.h"
#include "sss/image/error_image.h"
#include "sss/image/exr_file.h"
#include "sss/image/metrics.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

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

struct Figure {
    const char *name, *key;
    double ImageDifference::*value;
};
constexpr Figure kFigures[] = {{"relative RMSE", "relativeRmse", &ImageDifference::relativeRmse},
                               {"bias", "bias", &ImageDifference::bias},
                               {"maximum", "maximum", &ImageDifference::maximum}};

// JSON has no numbers that are not finite.
JsonValue jsonNumber(double value) { return std::isfinite(value) ? JsonValue(value) : JsonValue(); }

void printJson(const std::vector<ImageDifference>& differences, const CompareRequest& request) {
    JsonValue out = JsonValue::object();
    out.set("layer", request.layer)
        .set("pictures", differences.size())
        .set("pixels", differences.front().pixels)
        .set("referenceMean", jsonNumber(differences.front().referenceMean));
    for (const Figure& figure : kFigures) {
        const MeanAndError e = meanOver(differences, figure.value);
        JsonValue entry = JsonValue::object();
        entry.set("mean", jsonNumber(e.mean)).set("standardError", jsonNumber(e.error));
        out.set(figure.key, entry);
    }
    fmt::print("{}\n", dump(out));
}

void printText(const std::vector<ImageDifference>& differences, const CompareRequest& request) {
    fmt::print("{}: {} pixels, mean of the reference {:.6g}\n",
               request.layer.empty() ? "beauty" : request.layer, differences.front().pixels,
               differences.front().referenceMean);
    for (const Figure& figure : kFigures) {
        const MeanAndError e = meanOver(differences, figure.value);
        fmt::print("{:<14}{:>12.6g}", figure.name, e.mean);
        if (differences.size() > 1) fmt::print("  +- {:.2g}", e.error);
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

    std::vector<ImageDifference> differences;
    for (std::size_t k = 0; k + 1 < request.files.size(); ++k) {
        const std::string file = request.files[k].string();
        const LayeredImage image = readExr(file);
        if (image.width != reference.width || image.height != reference.height)
            throw Error(ErrorKind::BadInput, file,
                        fmt::format("is {} x {} pixels, the reference {} x {}", image.width,
                                    image.height, reference.width, reference.height),
                        "compare pictures of one size");
        const ImageLayer& layer = layerOf(image, file, request.layer);
        differences.push_back(compareLayers(layer, expected, masked));
        if (k == 0 && !request.errorImage.empty())
            writePng(request.errorImage, errorImage(layer, expected, image.width, masked));
    }
    if (request.json)
        printJson(differences, request);
    else
        printText(differences, request);
}
