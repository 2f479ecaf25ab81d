#pragma once
#include "sss/base/sampler.h"
#include "sss/integrate/body_optics.h"
#include "sss/integrate/light_sampling.h"
#include "sss/world/world.h"

#include <functional>
#include <span>

namespace sss {

/// Light that arrives from outside along a ray: lights, weighted by the given density against light
/// sampling from `sampledFrom`, and whatever else the caller's light transport finds there.
using IncomingRadiance =
    std::function<Rgb(const Ray& ray, const Vec3& sampledFrom, float scatterPdf)>;

/// Ray counts of single scattering.
struct SingleScatterCounts {
    std::uint64_t samples = 0, rays = 0;
};

/// Whether light from outside may be scattered within single scattering's reach of a place of a
/// body's surface: false only where none of the lights can shine there, nor, if paths are to
/// bounce, on any surface. Nanoseconds.
bool mayScatterOnce(const World& world, const BodyOptics& optics, const Vec3& place);

/// Where single scattering is looked for.
struct SingleQuery {
    const BodyOptics* optics;
    const SurfaceHit* hit;  ///< on the body
    Vec3 wo, normal;        ///< unit, away from the surface
    Sampler sampler;        ///< of this place's own
};
/// What is found there: the radiance that leaves is that of `radiance`, and `weight` times what
/// arrives along `ray`, weighted against light sampling as `origin` says. No ray if the weight is
/// 0.
struct SingleFound {
    Rgb radiance{0.0f};
    Rgb weight{0.0f};
    Ray ray;
    ScatterOrigin origin;
};
inline constexpr std::size_t kMostSingle = 16;

/// One estimate each of the radiance that leaves bodies at at most kMostSingle places after exactly
/// one scattering inside [JMLH01 section 2.3, rigorous form]; cheaper for places close together.
///
/// A distance s is sampled along the refracted ray by its extinction, on the way out or on both
/// ways; at that point in-scattered light is found by light sampling, or by sampling the phase
/// function or the half-space above the surface, weighted by the power heuristic. Light is taken to
/// come in straight, and its path inside is corrected by Snell's law [JMLH01 Eq. 8], exact for a
/// plane boundary:
///   L_o = F_t(w_o)/eta^2  int sigma_s e^{-sigma_t s}  int p F_t(w_i) (mu_i / mu_i') e^{-sigma_t
///   s_i'} L_i dw_i ds
/// with dw_i in exterior solid angle. The factor (mu_i / mu_i') and 1/eta^2 are what [JMLH01 Eq. 7]
/// leaves out. Needs a closed body: where a ray finds no way out nothing is added.
void singleScattering(const World& world, std::span<SingleQuery> queries,
                      std::span<SingleFound> found, SingleScatterCounts& counts);

/// The same for one place, with what `incoming` says of the light that arrives.
Rgb singleScattering(const World& world, const BodyOptics& optics, const SurfaceHit& hit,
                     const Vec3& wo, const Vec3& normal, Sampler& sampler,
                     const IncomingRadiance& incoming, SingleScatterCounts& counts);

}  // namespace sss
