#include "sss/integrate/irradiance.h"

#include "sss/base/parallel.h"
#include "sss/base/warp.h"
#include "sss/optics/fresnel.h"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace sss {
namespace {

constexpr std::size_t kGrain = 64;

class IrradianceEstimator {
public:
    IrradianceEstimator(const World& world, const PathTracer& tracer, float eta)
        : world_(world), tracer_(tracer), eta_(eta) {}

    Rgb estimate(const SurfaceHit& hit, Sampler& sampler, PathCounts& counts) const {
        Vec3 normal = hit.shadingNormal;
        if (glm::dot(normal, hit.geometricNormal) <= 0) normal = hit.geometricNormal;
        const Vec3 from = world_.leave(hit, hit.geometricNormal);
        return direct(hit, normal, from, sampler, counts) +
               scattered(hit, normal, from, sampler, counts);
    }

private:
    float entering(float cosine) const { return 1.0f - fresnelReflectance(cosine, eta_); }

    Rgb direct(const SurfaceHit& hit, const Vec3& normal, const Vec3& from, Sampler& sampler,
               PathCounts& counts) const {
        const float uPick = sampler.next1D();
        const DirectSample light = sampleDirect(world_, from, uPick, sampler.next2D());
        if (!(light.pdf > 0)) return Rgb(0);
        const float cosine = glm::dot(light.direction, normal);
        if (cosine <= 0 || glm::dot(light.direction, hit.geometricNormal) <= 0) return Rgb(0);
        ++counts.rays;
        if (!isVisible(world_, from, light)) return Rgb(0);
        const float weight = light.isDelta ? 1.0f : powerHeuristic(light.pdf, cosine / kPiF);
        return light.radianceOverPdf * (cosine * entering(cosine) * weight);
    }

    // Along a cosine-distributed direction: lights that scattering finds, and indirect light.
    Rgb scattered(const SurfaceHit& hit, const Vec3& normal, const Vec3& from, Sampler& sampler,
                  PathCounts& counts) const {
        const Vec3 local = cosineDirection(sampler.next2D());
        const float cosine = local.z;
        Ray ray;
        ray.origin = from;
        ray.direction = Frame(normal).toWorld(local);
        if (cosine <= 0 || glm::dot(ray.direction, hit.geometricNormal) <= 0) return Rgb(0);
        const ScatterOrigin origin{from, cosine / kPiF};
        return tracer_.incoming(ray, origin, world_.scene().quality.bounces, sampler, counts) *
               (entering(cosine) * kPiF);
    }

    const World& world_;
    const PathTracer& tracer_;
    float eta_;
};

}  // namespace

int irradianceSamplesFor(const QualitySettings& quality) {
    if (quality.irradianceSamples > 0) return quality.irradianceSamples;
    // A tenth of a point's noise is left after the sum over its neighbours; stratified, n samples
    // of an even environment have a relative error of about 1 / n.
    return static_cast<int>(std::clamp(0.24 / quality.tolerance, 12.0, 1024.0));
}

IrradianceResult computeIrradiance(const World& world, int body, const SurfaceSamples& samples,
                                   const PathTracer& tracer, Reporter& reporter) {
    IrradianceResult result;
    result.irradiance.assign(samples.size(), Rgb(0));
    const QualitySettings& quality = world.scene().quality;
    const int wanted = irradianceSamplesFor(quality);
    const std::uint64_t seed =
        combineSeeds(combineSeeds(quality.seed, 0x1bbadull), static_cast<std::uint64_t>(body));
    const TranslucentMaterial& material =
        world.materialOf(world.bodies()[static_cast<std::size_t>(body)]);
    const IrradianceEstimator estimator(world, tracer, static_cast<float>(material.medium.eta));

    Progress progress(reporter, "irradiance", samples.size());
    std::vector<double> variances(samples.size(), 0.0);
    std::mutex mutex;
    std::uint64_t estimates = 0;
    parallelFor(samples.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        PathCounts counts;
        std::uint64_t spent = 0, dropped = 0;
        for (std::size_t p = begin; p < end; ++p) {
            const std::uint32_t first = samples.firstStratum[p];
            const auto strata = static_cast<int>(samples.firstStratum[p + 1] - first);
            const int rounds = (wanted + strata - 1) / strata;
            const int n = rounds * strata;
            DRgb sum(0);
            double squares = 0;
            for (int k = 0; k < n; ++k) {
                const std::uint32_t s = first + static_cast<std::uint32_t>(k % strata);
                const SurfaceHit hit =
                    world.surfaceOf(body, samples.strata.faces[s], samples.strata.barycentrics[s]);
                Sampler sampler(combineSeeds(seed, p), static_cast<std::uint32_t>(k));
                const Rgb e = estimator.estimate(hit, sampler, counts);
                if (!isFinite(e)) {
                    ++dropped;
                    continue;
                }
                sum += DRgb(e);
                squares += static_cast<double>(meanComponent(e)) * meanComponent(e);
            }
            result.irradiance[p] = Rgb(sum / static_cast<double>(n));
            const double mean = (sum.x + sum.y + sum.z) / (3.0 * n);
            variances[p] = std::max(0.0, squares / n - mean * mean) / n;
            spent += static_cast<std::uint64_t>(n);
        }
        progress.advance(end - begin);
        const std::scoped_lock lock(mutex);
        result.counts.add(counts);
        estimates += spent;
        result.nonFinite += dropped;
    });
    double variance = 0, mean = 0;
    for (std::size_t p = 0; p < samples.size(); ++p) {
        variance += variances[p];
        mean += meanComponent(result.irradiance[p]);
    }
    const auto count = static_cast<double>(samples.size());
    if (mean > 0) result.pointNoise = std::sqrt(variance / count) / (mean / count);
    if (count > 0)
        result.samplesPerPoint =
            static_cast<int>(std::lround(static_cast<double>(estimates) / count));
    return result;
}

}  // namespace sss
