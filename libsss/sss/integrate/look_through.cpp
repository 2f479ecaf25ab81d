#include "sss/integrate/look_through.h"

#include "sss/integrate/smooth_boundary.h"
#include "sss/optics/fresnel.h"

#include <algorithm>

namespace sss {
namespace {

constexpr int kMostSightLegs = 16;
// Optical depth of a ten-thousandth: fainter than this nobody sees.
constexpr float kUnseenDepth = 9.2f;

Rgb reducedExtinction(const Medium& medium) {
    Rgb extinction;
    for (int c = 0; c < 3; ++c) extinction[c] = static_cast<float>(medium.channel(c).sigmaTPrime());
    return extinction;
}

}  // namespace

std::optional<LookThrough> lookThrough(const World& world, const BodyOptics& optics,
                                       const SurfaceHit& hit, const Vec3& wo, Sampler& sampler,
                                       std::uint64_t& rays) {
    Vec3 normal = hit.shadingNormal;
    if (glm::dot(normal, wo) <= 0) normal = hit.geometricNormal;
    const float cosine = glm::dot(normal, wo), inside = refractedCosine(cosine, optics.eta);
    if (!(cosine > 0 && inside > 0)) return std::nullopt;
    const Rgb extinction = reducedExtinction(optics.material.medium);
    const float least = std::min({extinction.x, extinction.y, extinction.z});
    LookThrough seen;
    Rgb straight(1), faded(1);
    Ray ray;
    ray.origin = world.leave(hit, -hit.geometricNormal);
    ray.direction = glm::normalize(refractedDirection(-wo, normal, cosine, inside, optics.eta));
    for (int leg = 0; leg < kMostSightLegs; ++leg) {
        if (least > 0) ray.tMax = kUnseenDepth / least;
        Hit found;
        ++rays;
        if (!world.rays().intersect(ray, found, bodyMask(hit.body))) return std::nullopt;
        straight *= glm::exp(-extinction * found.t);
        faded *= glm::exp(-optics.fading * found.t);
        const SurfaceHit exit = world.surfaceAt(found);
        if (glm::dot(ray.direction, exit.geometricNormal) <= 0) {
            // The outside of another of the body's shells: still inside.
            ray.origin = world.leave(exit, -exit.geometricNormal);
            continue;
        }
        const BoundaryEvent event =
            sampleBoundary(exit, ray.direction, optics.eta, sampler.next1D());
        ray.origin = world.leave(exit, event.side);
        ray.direction = event.direction;
        if (event.isInside) continue;
        seen.weight = straight * (1.0f - fresnelReflectance(cosine, optics.eta));
        seen.shown = Rgb(1) - faded;
        seen.beyond.origin = ray.origin;
        seen.beyond.direction = ray.direction;
        return seen;
    }
    return std::nullopt;
}

}  // namespace sss
