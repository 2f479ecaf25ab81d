#pragma once
#include "sss/base/vec.h"
#include "sss/image/image.h"

#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sss {

/// What one camera sample brings home: radiance in W m^-2 sr^-1, and of the first surface hit its
/// albedo, unit normal and distance. A ray that hits nothing leaves the last three as they are.
struct FilmSample {
    Rgb diffusion{0.0f}, single{0.0f}, surface{0.0f};
    float alpha = 0;
    Rgb albedo{0.0f};
    Vec3 normal{0.0f};
    float depth = std::numeric_limits<float>::infinity();  ///< mm along the viewing axis
};

/// Depth of a pixel in which every sample missed: large, but finite, because filters in
/// compositing turn infinities into NaN (Arnold's convention).
inline constexpr float kNoDepth = 1e30f;

/// What a pixel gathers: sums in double over the samples that were kept.
struct FilmPixel {
    DRgb diffusion{0}, single{0}, surface{0}, squares{0};
    DRgb albedo{0};
    DVec3 normal{0};
    double alpha = 0, depth = 0;
    std::uint32_t samples = 0, hits = 0, dropped = 0;

    /// A sample that is not finite, or whose radiance, alpha or albedo is negative, is dropped
    /// whole and counted; the mean is then over the others.
    void add(std::span<const FilmSample> taken);
    void add(const FilmSample& sample) { add(std::span(&sample, 1)); }
};

/// A layer that can be asked for beside the beauty: one row of a table.
struct FilmLayer {
    std::string_view name;
    std::vector<std::string> channels;
    bool fullPrecision;
    void (*write)(const FilmPixel& pixel, std::span<float> channels);
};

/// Every layer that Film knows: diffusion, single, surface (R,G,B; they sum to the beauty), albedo
/// (R,G,B), N (X,Y,Z; not renormalised), Z (mean over the samples that hit; kNoDepth if none did),
/// variance (R,G,B, of the pixel's beauty if its samples were independent, so an upper bound for
/// stratified ones), sampleCount. Means are over all kept samples, the background counting as 0.
std::span<const FilmLayer> filmLayers();

/// A picture in the making, pixel by pixel. Any number of threads may set pixels of their own.
class Film {
public:
    /// `layers` names what is kept beside the beauty, in this order; `everywhere` is what the
    /// pixels hold that are not set. Throws Error{BadInput} for an unknown or repeated name.
    Film(int width, int height, const std::vector<std::string>& layers,
         const FilmPixel& everywhere = {});

    /// Writes a pixel's means.
    void set(int x, int y, const FilmPixel& pixel);

    struct Dropped {
        std::uint64_t samples = 0;
        int firstX = -1, firstY = -1;  ///< first pixel concerned, row by row
    };
    /// Of the pixels that were set.
    const Dropped& dropped() const { return dropped_; }

    /// The means: "R,G,B,A", exactly diffusion + single + surface in float, then the layers.
    LayeredImage take() && { return std::move(image_); }

private:
    void count(int x, int y, std::uint32_t dropped);

    std::vector<const FilmLayer*> layers_;
    LayeredImage image_;
    std::mutex droppedMutex_;
    Dropped dropped_;
};

}  // namespace sss
