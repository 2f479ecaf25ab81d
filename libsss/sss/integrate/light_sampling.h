#pragma once
#include "sss/base/sampler.h"
#include "sss/geom/ray_scene.h"
#include "sss/world/world.h"

#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace sss {

/// One way to one light: next-event estimation. Not yet known to be free of obstacles.
struct DirectSample {
    Vec3 direction{};
    float distance = 0;
    /// Radiance over the density of the direction; for delta lights, irradiance on a facing surface
    /// over the probability of the pick.
    Rgb radianceOverPdf{0.0f};
    float pdf = 0;  ///< sr^-1, times the probability of the pick; 0 = nothing found
    bool isDelta = false;
    /// Index of the glowing volume that it looks for, whose emission up to where its ray is stopped
    /// stands for the radiance; -1 for all other lights.
    int volume = -1;
};
DirectSample sampleDirect(const World& world, const Vec3& from, float uPick, const Vec2& u);
/// The same of a light that has been picked.
DirectSample sampleDirect(const World& world, const LightPicker::Pick& pick, const Vec3& from,
                          const Vec2& u);
/// The same from a surface, by queryAbove().
DirectSample sampleDirect(const World& world, const Vec3& from, const Vec3& normal,
                          Sampler& sampler);
/// Where a light that has been picked is sampled from, and by which numbers.
struct LightQuery {
    LightPicker::Pick pick;
    Vec3 from;
    Vec2 u;
};
inline constexpr std::size_t kMostDirect = 16;
/// sampleDirect() for several, at most kMostDirect: cheaper together.
void sampleDirect(const World& world, std::span<const LightQuery> queries,
                  std::span<DirectSample> samples);
/// A light that a surface of geometric normal `normal` may see; takes two numbers of the sampler,
/// but computes only those that it needs. Nothing if light comes from below.
std::optional<LightQuery> queryAbove(const World& world, const Vec3& from, const Vec3& normal,
                                     Sampler& sampler);

/// From a point (already off its surface) to just before the end of a DirectSample.
Ray shadowRay(const Vec3& from, const DirectSample& sample);

/// How a ray's direction was chosen, for weighing the lights that it finds against light sampling.
struct ScatterOrigin {
    Vec3 sampledFrom{};  ///< where light sampling would have started
    float pdf =
        std::numeric_limits<float>::infinity();  ///< sr^-1; infinite for cameras and mirrors
    bool afterVolume = false;  ///< a volume has scattered the path before: none will again
};
/// Radiance of the lights that a ray of length `distance` meets (infinite if it left the scene),
/// each weighted against light sampling by the power heuristic, less what volumes take of it.
Rgb radianceOfLights(const World& world, const Ray& ray, float distance,
                     const ScatterOrigin& origin);
/// The same of all lights along a ray that nothing stands before, without volumes; `rays` counts
/// what had to be traced to know, which is nothing where there is no light.
Rgb radianceOfOpenLights(const World& world, const Ray& ray, const ScatterOrigin& origin,
                         std::uint64_t& rays);
/// The same without a look at what stands before them; `isNear` if one of them is not infinitely
/// far.
Rgb radianceOfLightsAlong(const World& world, const Ray& ray, const ScatterOrigin& origin,
                          bool& isNear);
/// The same for the emitting surface that a ray hit, without volumes.
Rgb radianceOfEmitter(const World& world, const Ray& ray, const SurfaceHit& hit,
                      const ScatterOrigin& origin);

/// Weight of a sample of density `pdf` beside another technique of density `other`.
inline float powerHeuristic(float pdf, float other) {
    if (std::isinf(pdf)) return 1.0f;
    const float ratio = other / pdf;
    return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace sss
