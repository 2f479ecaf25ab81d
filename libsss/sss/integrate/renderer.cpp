#include "sss/integrate/renderer.h"

#include "sss/base/parallel.h"
#include "sss/image/filter.h"
#include "sss/integrate/foreground.h"

#include <algorithm>
#include <array>
#include <mutex>

namespace sss {
namespace {

constexpr int kTile = 16;  // pixels

struct Tile {
    int x0, y0, x1, y1;
};

// Takes all samples of a pixel.
class PixelSampler {
public:
    PixelSampler(const World& world, const PathTracer& tracer)
        : settings_(world.scene().film),
          camera_(world.camera()),
          tracer_(tracer),
          filter_(settings_.filter, settings_.filterRadiusPixels),
          foreground_(world, static_cast<float>(filter_.radiusPixels())),
          seed_(combineSeeds(world.scene().quality.seed, 0xca3e7aull)) {}

    void sample(int x, int y, Film& film, PathCounts& counts) const {
        std::array<FilmSample, PathTracer::kMostViews> seen;
        const bool isForeground = foreground_.mayShow(x, y);
        if (!isForeground) {
            counts.cameraSamples += static_cast<std::uint64_t>(settings_.samples);
            for (FilmSample& sample : seen) sample.surface = foreground_.background();
        }
        for (int first = 0; first < settings_.samples; first += static_cast<int>(seen.size())) {
            const std::size_t count =
                std::min(seen.size(), static_cast<std::size_t>(settings_.samples - first));
            if (isForeground) look(x, y, first, std::span(seen).first(count), counts);
            film.add(x, y, std::span(seen).first(count));
        }
    }

private:
    // Consecutive samples of a pixel.
    void look(int x, int y, int first, std::span<FilmSample> seen, PathCounts& counts) const {
        const std::uint64_t pixelSeed = combineSeeds(
            seed_, static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint64_t>(x));
        const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        std::array<Ray, PathTracer::kMostViews> rays;
        std::array<Sampler, PathTracer::kMostViews> samplers;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            Sampler& sampler = samplers[i];
            sampler = Sampler(pixelSeed,
                              static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(i));
            const Vec2 pixel = centre + filter_.sample(sampler.next2D());
            Vec2 lens(0.5f);
            if (camera_.hasLens())
                lens = sampler.next2D();
            else
                sampler.skip();
            rays[i] = camera_.ray(pixel, lens);
        }
        tracer_.trace(std::span(rays).first(seen.size()), samplers, seen, counts);
    }

    const FilmSettings& settings_;
    const Camera& camera_;
    const PathTracer& tracer_;
    PixelFilter filter_;
    Foreground foreground_;
    std::uint64_t seed_;
};

}  // namespace

RenderResult render(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                    std::span<const std::unique_ptr<BodyField>> fields, Reporter& reporter) {
    const FilmSettings& settings = world.scene().film;
    const PathTracer tracer(world, optics, fields);
    Film film(settings.width, settings.height, settings.layers);
    RenderResult result;

    std::vector<Tile> tiles;
    for (int y = 0; y < settings.height; y += kTile)
        for (int x = 0; x < settings.width; x += kTile)
            tiles.push_back(
                {x, y, std::min(x + kTile, settings.width), std::min(y + kTile, settings.height)});
    Progress progress(reporter, "render", tiles.size());
    const PixelSampler pixels(world, tracer);
    std::mutex mutex;
    parallelFor(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
        PathCounts counts;
        for (std::size_t t = begin; t < end; ++t) {
            const Tile& tile = tiles[t];
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x) pixels.sample(x, y, film, counts);
            progress.advance();
        }
        const std::scoped_lock lock(mutex);
        result.counts.add(counts);
    });
    result.image = film.develop();
    result.dropped = film.dropped();
    return result;
}

}  // namespace sss
