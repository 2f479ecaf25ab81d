#include "sss/integrate/single_exitance.h"

#include "sss/base/parallel.h"
#include "sss/base/warp.h"

#include <mutex>

namespace sss {
namespace {

constexpr std::size_t kPointsPerSingleTask = 64;

}  // namespace

std::vector<Rgb> singleExitance(const World& world, int body, const SurfaceSamples& samples,
                                const PathTracer& tracer, int samplesPerPoint, PathCounts& counts) {
    const std::uint64_t seed = combineSeeds(combineSeeds(world.scene().quality.seed, 0x51e6ull),
                                            static_cast<std::uint64_t>(body));
    const auto n = static_cast<std::uint32_t>(samplesPerPoint);
    std::vector<Rgb> exitance(samples.size(), Rgb(0));
    std::mutex mutex;
    parallelFor(samples.size(), kPointsPerSingleTask, [&](std::size_t begin, std::size_t end) {
        PathCounts own;
        for (std::size_t p = begin; p < end; ++p) {
            DRgb sum{0};
            for (std::uint32_t k = 0; k < n; ++k) {
                Sampler sampler(seed, static_cast<std::uint32_t>(p) * n + k);
                const SurfacePlace place = samples.cells.placeIn(p, sampler.next2D());
                const SurfaceHit hit = world.surfaceOf(body, place.face, place.barycentrics);
                const Vec3 wo =
                    Frame(hit.geometricNormal).toWorld(cosineDirection(sampler.next2D()));
                const Rgb radiance =
                    tracer.singleScatteringAt(hit, wo, hit.geometricNormal, sampler, own);
                if (isFinite(radiance)) sum += DRgb(radiance);
            }
            exitance[p] = Rgb(sum * (kPi / static_cast<double>(n)));
        }
        const std::scoped_lock lock(mutex);
        counts.add(own);
    });
    return exitance;
}

}  // namespace sss
