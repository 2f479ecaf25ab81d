#include "sss/integrate/renderer.h"

#include "sss/base/parallel.h"
#include "sss/integrate/integrator_table.h"

#include <algorithm>
#include <mutex>

namespace sss {
namespace {

constexpr int kTile = 16;  // pixels

struct Tile {
    int x0, y0, x1, y1;
};

}  // namespace

RenderResult render(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                    std::span<const std::unique_ptr<BodyField>> fields, Reporter& reporter) {
    const FilmSettings& settings = world.scene().film;
    const auto integrator = integratorOf(world.scene()).make({world, optics, fields});
    const PixelFilter filter(settings.filter, settings.filterRadiusPixels);
    Film film(settings.width, settings.height, settings.layers);
    RenderResult result;

    std::vector<Tile> tiles;
    for (int y = 0; y < settings.height; y += kTile)
        for (int x = 0; x < settings.width; x += kTile)
            tiles.push_back(
                {x, y, std::min(x + kTile, settings.width), std::min(y + kTile, settings.height)});
    Progress progress(reporter, "render", tiles.size());
    const std::uint64_t seed = combineSeeds(world.scene().quality.seed, 0xca3e7aull);
    std::mutex mutex;
    parallelFor(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
        PathCounts counts;
        for (std::size_t t = begin; t < end; ++t) {
            const Tile& tile = tiles[t];
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x) {
                    const std::uint64_t pixelSeed = combineSeeds(
                        seed, static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint64_t>(x));
                    for (int s = 0; s < settings.samples; ++s) {
                        Sampler sampler(pixelSeed, static_cast<std::uint32_t>(s));
                        const Vec2 centre(static_cast<float>(x) + 0.5f,
                                          static_cast<float>(y) + 0.5f);
                        const Vec2 pixel = centre + filter.sample(sampler.next2D());
                        const Ray ray = world.camera().ray(pixel, sampler.next2D());
                        film.add(x, y, integrator->trace(ray, sampler, counts));
                    }
                }
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
