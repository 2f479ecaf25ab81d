#include "sss/integrate/renderer.h"

#include "sss/base/parallel.h"
#include "sss/image/filter.h"
#include "sss/integrate/foreground.h"
#include "sss/integrate/integrator_table.h"

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
    // Room for the samples that are taken together; one a thread.
    struct Room {
        std::array<Ray, Integrator::kMostViews> rays;
        std::array<Sampler, Integrator::kMostViews> samplers;
        std::array<FilmSample, Integrator::kMostViews> seen;
        PathCounts counts;
    };
    PixelSampler(const World& world, const Integrator& integrator)
        : settings_(world.scene().film),
          camera_(world.camera()),
          integrator_(integrator),
          filter_(settings_.filter, settings_.filterRadiusPixels),
          foreground_(world, static_cast<float>(filter_.radiusPixels())),
          seed_(combineSeeds(world.scene().quality.seed, 0xca3e7aull) ^
                mix64(world.scene().quality.cameraSeed)) {}

    /// What is seen where nothing stands before the background.
    FilmPixel background() const {
        FilmSample seen;
        seen.surface = foreground_.background();
        FilmPixel pixel;
        for (int i = 0; i < settings_.samples; ++i) pixel.add(seen);
        return pixel;
    }

    void sample(int x, int y, Film& film, Room& room) const {
        if (!foreground_.mayShow(x, y)) {
            room.counts.cameraSamples += static_cast<std::uint64_t>(settings_.samples);
            return;
        }
        FilmPixel pixel;
        for (int first = 0; first < settings_.samples;
             first += static_cast<int>(room.seen.size())) {
            const std::size_t count =
                std::min(room.seen.size(), static_cast<std::size_t>(settings_.samples - first));
            look({x, y}, first, count, room);
            pixel.add(std::span(room.seen).first(count));
        }
        film.set(x, y, pixel);
    }

private:
    struct Pixel {
        int x, y;
    };
    // Takes `count` samples of a pixel from number `first` on.
    void look(const Pixel& pixel, int first, std::size_t count, Room& room) const {
        const std::uint64_t seed = combineSeeds(
            seed_, static_cast<std::uint64_t>(pixel.y) << 32 | static_cast<std::uint64_t>(pixel.x));
        const Vec2 centre(static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f);
        for (std::size_t i = 0; i < count; ++i)
            room.samplers[i] =
                Sampler(seed, static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(i));
        const auto samplers = std::span(room.samplers).first(count);
        std::array<Vec2, Integrator::kMostViews> places, lenses{};
        Sampler::next2D(samplers, places);
        if (camera_.hasLens())
            Sampler::next2D(samplers, lenses);
        else
            for (Sampler& sampler : samplers) sampler.skip();
        for (std::size_t i = 0; i < count; ++i)
            room.rays[i] = camera_.ray(centre + filter_.sample(places[i]), lenses[i]);
        integrator_.traceAll(std::span(room.rays).first(count), samplers,
                             std::span(room.seen).first(count), room.counts);
    }

    const FilmSettings& settings_;
    const Camera& camera_;
    const Integrator& integrator_;
    PixelFilter filter_;
    Foreground foreground_;
    std::uint64_t seed_;
};

}  // namespace

RenderResult render(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                    std::span<const std::unique_ptr<BodyField>> fields, Reporter& reporter) {
    const FilmSettings& settings = world.scene().film;
    const auto integrator = integratorOf(world.scene()).make({world, optics, fields});
    const PixelSampler pixels(world, *integrator);
    Film film(settings.width, settings.height, settings.layers, pixels.background());
    RenderResult result;

    std::vector<Tile> tiles;
    for (int y = 0; y < settings.height; y += kTile)
        for (int x = 0; x < settings.width; x += kTile)
            tiles.push_back(
                {x, y, std::min(x + kTile, settings.width), std::min(y + kTile, settings.height)});
    Progress progress(reporter, "render", tiles.size());
    std::mutex mutex;
    parallelFor(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
        PixelSampler::Room room;
        for (std::size_t t = begin; t < end; ++t) {
            const Tile& tile = tiles[t];
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x) pixels.sample(x, y, film, room);
            progress.advance();
        }
        const std::scoped_lock lock(mutex);
        result.counts.add(room.counts);
    });
    result.dropped = film.dropped();
    result.image = std::move(film).take();
    return result;
}

}  // namespace sss
