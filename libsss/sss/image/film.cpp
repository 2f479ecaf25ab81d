#include "sss/image/film.h"

#include "sss/base/assert.h"
#include "sss/base/error.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace sss {
namespace {

void write(const Vec3& value, std::span<float> channels) {
    channels[0] = value.x;
    channels[1] = value.y;
    channels[2] = value.z;
}

Vec3 mean(const DVec3& sum, std::uint32_t count) {
    return count == 0 ? Vec3{0.0f} : Vec3(sum / static_cast<double>(count));
}

Rgb diffusionOf(const FilmPixel& p) { return mean(p.diffusion, p.samples); }
Rgb singleOf(const FilmPixel& p) { return mean(p.single, p.samples); }
Rgb surfaceOf(const FilmPixel& p) { return mean(p.surface, p.samples); }

float depthOf(const FilmPixel& p) {
    return p.hits == 0 ? kNoDepth : static_cast<float>(p.depth / p.hits);
}

/// Variance of the mean of the pixel's samples.
Rgb varianceOf(const FilmPixel& p) {
    if (p.samples < 2) return Rgb{0.0f};
    const double n = p.samples;
    const DRgb sum = p.diffusion + p.single + p.surface;
    return Rgb(glm::max(p.squares - sum * sum / n, DRgb{0}) / (n * (n - 1)));
}

const std::vector<FilmLayer> kLayers{
    {"diffusion",
     {"R", "G", "B"},
     false,
     [](const FilmPixel& p, std::span<float> out) { write(diffusionOf(p), out); }},
    {"single",
     {"R", "G", "B"},
     false,
     [](const FilmPixel& p, std::span<float> out) { write(singleOf(p), out); }},
    {"surface",
     {"R", "G", "B"},
     false,
     [](const FilmPixel& p, std::span<float> out) { write(surfaceOf(p), out); }},
    {"albedo",
     {"R", "G", "B"},
     false,
     [](const FilmPixel& p, std::span<float> out) { write(mean(p.albedo, p.samples), out); }},
    {"N",
     {"X", "Y", "Z"},
     false,
     [](const FilmPixel& p, std::span<float> out) { write(mean(p.normal, p.samples), out); }},
    {"Z", {"Z"}, true, [](const FilmPixel& p, std::span<float> out) { out[0] = depthOf(p); }},
    {"variance",
     {"R", "G", "B"},
     true,
     [](const FilmPixel& p, std::span<float> out) { write(varianceOf(p), out); }},
    {"sampleCount",
     {"sampleCount"},
     true,
     [](const FilmPixel& p, std::span<float> out) { out[0] = static_cast<float>(p.samples); }},
};

// A sample's numbers in the order of FilmSample: the first kNotNegative must not be negative, the
// first kFinite must be finite, the last is the depth.
using Numbers = std::array<float, 17>;
static_assert(sizeof(Numbers) == sizeof(FilmSample));
constexpr std::size_t kNotNegative = 13, kFinite = 16;

// Apart: inlined, GCC takes the numbers one by one.
[[gnu::noinline]] bool isUsable(const Numbers& numbers) {
    // On the bits, which is a few instructions for all numbers together: a number that is not
    // finite has all bits of its exponent set, and adding one there carries into the sign; one that
    // is negative has its sign set, and another bit (zero has a sign too).
    constexpr std::uint32_t kSign = 0x80000000u, kExponent = 0x7f800000u;
    const auto bits = std::bit_cast<std::array<std::uint32_t, 17>>(numbers);
    std::uint32_t bad = 0;
    for (std::size_t i = 0; i < kFinite; ++i)
        bad |= ((bits[i] & ~kSign) + (kSign - kExponent)) & kSign;
    for (std::size_t i = 0; i < kNotNegative; ++i)
        bad |= bits[i] & ((bits[i] & ~kSign) + ~kSign) & kSign;
    return bad == 0 && !std::isnan(numbers[kFinite]);
}

const FilmLayer* layerNamed(const std::string& name) {
    for (const FilmLayer& layer : kLayers)
        if (layer.name == name) return &layer;
    std::vector<std::string_view> names;
    for (const FilmLayer& layer : kLayers) names.push_back(layer.name);
    throw Error(ErrorKind::BadInput, "film", fmt::format("unknown layer \"{}\"", name),
                fmt::format("choose from {}", fmt::join(names, ", ")));
}

void writeBeauty(const FilmPixel& p, std::span<float> channels) {
    write(diffusionOf(p) + singleOf(p) + surfaceOf(p), channels);
    channels[3] = p.samples == 0 ? 0.0f : static_cast<float>(p.alpha / p.samples);
}

const FilmLayer kBeauty{"", {"R", "G", "B", "A"}, false, writeBeauty};

// A layer of `count` pixels that are all alike.
ImageLayer filled(const FilmLayer& layer, const FilmPixel& pixel, std::size_t count) {
    std::vector<float> one(layer.channels.size());
    layer.write(pixel, one);
    ImageLayer result{std::string(layer.name), layer.channels, {}, layer.fullPrecision};
    result.values.reserve(count * one.size());
    for (std::size_t i = 0; i < count; ++i)
        result.values.insert(result.values.end(), one.begin(), one.end());
    return result;
}

}  // namespace

std::span<const FilmLayer> filmLayers() { return kLayers; }

void FilmPixel::add(std::span<const FilmSample> taken) {
    std::array<double, kFinite> sums{};  // apart, so that the loop over them is a few instructions
    for (const FilmSample& sample : taken) {
        const auto numbers = std::bit_cast<Numbers>(sample);
        if (!isUsable(numbers)) {
            ++dropped;
            continue;
        }
        ++samples;
        for (std::size_t i = 0; i < kFinite; ++i) sums[i] += static_cast<double>(numbers[i]);
        const DRgb radiance = DRgb(sample.diffusion) + DRgb(sample.single) + DRgb(sample.surface);
        squares += radiance * radiance;
        if (std::isfinite(sample.depth)) {
            ++hits;
            depth += static_cast<double>(sample.depth);
        }
    }
    diffusion += DRgb(sums[0], sums[1], sums[2]);
    single += DRgb(sums[3], sums[4], sums[5]);
    surface += DRgb(sums[6], sums[7], sums[8]);
    alpha += sums[9];
    albedo += DRgb(sums[10], sums[11], sums[12]);
    normal += DVec3(sums[13], sums[14], sums[15]);
}

Film::Film(int width, int height, const std::vector<std::string>& layers,
           const FilmPixel& everywhere)
    : layers_{&kBeauty}, image_{width, height, {}, {}} {
    for (const std::string& name : layers) {
        const FilmLayer* layer = layerNamed(name);
        if (std::find(layers_.begin(), layers_.end(), layer) != layers_.end())
            throw Error(ErrorKind::BadInput, "film",
                        fmt::format("layer \"{}\" is asked for twice", name), "name it once");
        layers_.push_back(layer);
    }
    for (const FilmLayer* layer : layers_)
        image_.layers.push_back(filled(*layer, everywhere, image_.pixelCount()));
}

void Film::set(int x, int y, const FilmPixel& pixel) {
    SSS_ASSERT_LT(x, image_.width);
    SSS_ASSERT_LT(y, image_.height);
    const std::size_t place = static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                              static_cast<std::size_t>(x);
    for (std::size_t k = 0; k < layers_.size(); ++k) {
        const std::size_t stride = layers_[k]->channels.size();
        layers_[k]->write(pixel, {image_.layers[k].values.data() + place * stride, stride});
    }
    if (pixel.dropped > 0) count(x, y, pixel.dropped);
}

void Film::count(int x, int y, std::uint32_t dropped) {
    const std::scoped_lock lock(droppedMutex_);
    const bool isFirst = dropped_.samples == 0 || y < dropped_.firstY ||
                         (y == dropped_.firstY && x < dropped_.firstX);
    dropped_.samples += dropped;
    if (!isFirst) return;
    dropped_.firstX = x;
    dropped_.firstY = y;
}

}  // namespace sss
