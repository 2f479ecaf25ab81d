#include "sss/image/film.h"

#include "sss/base/assert.h"
#include "sss/base/error.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
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

float lowest(const Rgb& c) { return std::min(c.x, std::min(c.y, c.z)); }

// Whether a sample can be kept, of which `radiance` is the sum. A sum in double does not overflow,
// so it is finite if every part is; NaN and infinity pass through.
bool isUsable(const FilmSample& s, const DRgb& radiance) {
    const DVec3 all = radiance + DRgb(s.albedo) + DVec3(s.normal);
    const float least = std::min(std::min(lowest(s.diffusion), lowest(s.single)),
                                 std::min(lowest(s.surface), lowest(s.albedo)));
    return std::isfinite(all.x + all.y + all.z + static_cast<double>(s.alpha)) && least >= 0 &&
           s.alpha >= 0 && !std::isnan(s.depth);
}

void gather(const FilmSample& sample, FilmPixel& pixel) {
    const DRgb diffusion(sample.diffusion), single(sample.single), surface(sample.surface);
    const DRgb sum = diffusion + single + surface;
    if (!isUsable(sample, sum)) {
        ++pixel.dropped;
        return;
    }
    ++pixel.samples;
    pixel.surface += surface;
    pixel.squares += sum * sum;
    pixel.diffusion += diffusion;
    pixel.single += single;
    pixel.albedo += DRgb(sample.albedo);
    pixel.normal += DVec3(sample.normal);
    pixel.alpha += static_cast<double>(sample.alpha);
    if (std::isfinite(sample.depth)) {
        ++pixel.hits;
        pixel.depth += static_cast<double>(sample.depth);
    }
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
    FilmPixel sum = *this;  // in registers
    for (const FilmSample& sample : taken) gather(sample, sum);
    *this = sum;
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
