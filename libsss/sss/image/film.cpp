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

ImageLayer beauty(const std::vector<FilmPixel>& pixels) {
    ImageLayer layer{"", {"R", "G", "B", "A"}, {}, false};
    layer.values.reserve(pixels.size() * 4);
    for (const FilmPixel& p : pixels) {
        const Rgb sum = diffusionOf(p) + singleOf(p) + surfaceOf(p);
        const double alpha = p.samples == 0 ? 0.0 : p.alpha / p.samples;
        layer.values.insert(layer.values.end(), {sum.x, sum.y, sum.z, static_cast<float>(alpha)});
    }
    return layer;
}

}  // namespace

std::span<const FilmLayer> filmLayers() { return kLayers; }

Film::Film(int width, int height, const std::vector<std::string>& layers)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    for (const std::string& name : layers) {
        const FilmLayer* layer = layerNamed(name);
        if (std::find(layers_.begin(), layers_.end(), layer) != layers_.end())
            throw Error(ErrorKind::BadInput, "film",
                        fmt::format("layer \"{}\" is asked for twice", name), "name it once");
        layers_.push_back(layer);
    }
}

void Film::add(int x, int y, std::span<const FilmSample> samples) {
    SSS_ASSERT_LT(x, width_);
    SSS_ASSERT_LT(y, height_);
    FilmPixel& place = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                               static_cast<std::size_t>(x)];
    FilmPixel pixel = place;
    for (const FilmSample& sample : samples) gather(sample, pixel);
    place = pixel;
}

Film::Dropped Film::dropped() const {
    Dropped result;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        if (pixels_[i].dropped == 0) continue;
        if (result.samples == 0) {
            result.firstX = static_cast<int>(i % static_cast<std::size_t>(width_));
            result.firstY = static_cast<int>(i / static_cast<std::size_t>(width_));
        }
        result.samples += pixels_[i].dropped;
    }
    return result;
}

LayeredImage Film::develop() const {
    LayeredImage image{width_, height_, {}, {}};
    image.layers.push_back(beauty(pixels_));
    for (const FilmLayer* wanted : layers_) {
        const std::size_t stride = wanted->channels.size();
        ImageLayer layer{std::string(wanted->name), wanted->channels, {}, wanted->fullPrecision};
        layer.values.resize(pixels_.size() * stride);
        for (std::size_t i = 0; i < pixels_.size(); ++i)
            wanted->write(pixels_[i], std::span(layer.values).subspan(i * stride, stride));
        image.layers.push_back(std::move(layer));
    }
    return image;
}

}  // namespace sss
