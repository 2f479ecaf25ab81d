#include "sss/integrate/single_scatter.h"

#include "sss/integrate/arriving_light.h"
#include "sss/integrate/medium_coefficients.h"
#include "sss/integrate/smooth_boundary.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/phase.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sss {
namespace {

// Where a straight line from inside meets the boundary on its way out.
struct Exit {
    Vec3 outside;  // just past the boundary
    float distance;
    float cosOutside, cosInside;
    Vec3 inward;  // propagation direction inside of light that comes in against the line
};

std::optional<Exit> findExit(const World& world, const BodyOptics& optics, int body,
                             const Vec3& from, const Vec3& direction) {
    Ray ray;
    ray.origin = from;
    ray.direction = direction;
    Hit hit;
    if (!world.rays().intersect(ray, hit, bodyMask(body))) return std::nullopt;
    const SurfaceHit surface = world.surfaceAt(hit);
    if (surface.body != body || glm::dot(surface.geometricNormal, direction) <= 0)
        return std::nullopt;
    Exit exit;
    exit.outside = world.leave(surface, surface.geometricNormal);
    exit.distance = hit.t;
    Vec3 normal = surface.shadingNormal;
    if (glm::dot(normal, direction) <= 0) normal = surface.geometricNormal;
    exit.cosOutside = glm::dot(normal, direction);
    exit.cosInside = refractedCosine(exit.cosOutside, optics.eta);
    if (!(exit.cosInside > 0)) return std::nullopt;  // eta < 1: no light comes in this way
    exit.inward =
        refractedDirection(-direction, normal, exit.cosOutside, exit.cosInside, optics.eta);
    return exit;
}

// Everything on the way in but the light itself, towards the outgoing propagation direction `out`.
Rgb entering(const MediumCoefficients& medium, const BodyOptics& optics, const Exit& exit,
             const Vec3& out) {
    const float snell = exit.cosOutside / exit.cosInside;
    const float boundary = (1.0f - fresnelReflectance(exit.cosOutside, optics.eta)) * snell;
    return phaseBetween(medium, exit.inward, out) * medium.transmittance(exit.distance * snell) *
           boundary;
}

struct Depth {
    float distance = 0;
    Rgb weight{0.0f};  // sigma_s e^{-sigma_t s} over the density of s
};

// Distance along the refracted ray: a channel is picked, its extinction sampled, and the three ways
// to the same distance combined by the balance heuristic.
Depth sampleDepth(const MediumCoefficients& medium, Sampler& sampler) {
    const float pick = sampler.next1D(), u = sampler.next1D();
    const int channel = std::min(2, static_cast<int>(pick * 3.0f));
    Depth depth;
    if (!(medium.sigmaT[channel] > 0)) return depth;
    depth.distance = -std::log1p(-u) / medium.sigmaT[channel];
    const Rgb remaining = medium.transmittance(depth.distance);
    const float density = meanComponent(medium.sigmaT * remaining);
    if (density > 0) depth.weight = medium.sigmaS * remaining / density;
    return depth;
}

// Share of the samples that look for light by light sampling; the others sample the phase function.
constexpr float kLightShare = 0.75f;

// What a place inside sends towards the outgoing propagation direction `out`, by one of the two
// techniques, weighted by the power heuristic for one sample.
class InScattering {
public:
    InScattering(const World& world, const BodyOptics& optics, const MediumCoefficients& medium,
                 int body, const Vec3& place, const Vec3& out)
        : world_(world), optics_(optics), medium_(medium), body_(body), place_(place), out_(out) {}

    Rgb estimate(Sampler& sampler, const IncomingRadiance& incoming,
                 SingleScatterCounts& counts) const {
        const float lightShare = world_.picker().empty() ? 0.0f : kLightShare;
        const float uTechnique = sampler.next1D(), uPick = sampler.next1D();
        const Vec2 u = sampler.next2D();
        if (uTechnique < lightShare) return byLight(lightShare, uPick, u, counts);
        return byPhase(lightShare, u, incoming, counts);
    }

private:
    float phasePdf(const Vec3& direction) const {
        return henyeyGreenstein(-glm::dot(direction, out_), meanComponent(medium_.g));
    }

    Rgb byLight(float share, float uPick, const Vec2& u, SingleScatterCounts& counts) const {
        const DirectSample direct = sampleDirect(world_, place_, uPick, u);
        if (!(direct.pdf > 0)) return Rgb(0);
        ++counts.rays;
        const auto exit = findExit(world_, optics_, body_, place_, direct.direction);
        if (!exit || exit->distance >= direct.distance) return Rgb(0);
        DirectSample rest = direct;
        rest.distance -= exit->distance;
        const Rgb arriving = arrivingShare(world_, exit->outside, rest, counts.rays);
        if (isZero(arriving)) return Rgb(0);
        const float weight =
            direct.isDelta
                ? 1.0f
                : powerHeuristic(share * direct.pdf, (1 - share) * phasePdf(direct.direction));
        return entering(medium_, optics_, *exit, out_) * arriving * direct.radianceOverPdf *
               (weight / share);
    }

    Rgb byPhase(float lightShare, const Vec2& u, const IncomingRadiance& incoming,
                SingleScatterCounts& counts) const {
        const Vec3 direction = sampleScattered(-out_, meanComponent(medium_.g), u);
        const float pdf = (1 - lightShare) * phasePdf(direction);
        if (!(pdf > 0)) return Rgb(0);
        ++counts.rays;
        const auto exit = findExit(world_, optics_, body_, place_, direction);
        if (!exit) return Rgb(0);
        Ray outward;
        outward.origin = exit->outside;
        outward.direction = direction;
        // Infinite without light sampling: nothing to share with.
        return entering(medium_, optics_, *exit, out_) *
               incoming(outward, place_, pdf / lightShare) / pdf;
    }

    const World& world_;
    const BodyOptics& optics_;
    const MediumCoefficients& medium_;
    int body_;
    Vec3 place_, out_;
};

}  // namespace

bool mayScatterOnce(const World& world, const BodyOptics& optics, const Vec3& place) {
    if (!(optics.singleReachMm > 0)) return false;
    if (world.hasVolumes()) return true;  // they throw light back from where no light is
    const Vec3 reach(optics.singleReachMm);
    const Bounds near{place - reach, place + reach};
    const Bounds& box = world.scene().quality.bounces > 0 ? world.bounds() : near;
    return std::ranges::any_of(world.lights(),
                               [&](const auto& light) { return light->importance(box) > 0; });
}

Rgb singleScattering(const World& world, const BodyOptics& optics, const SurfaceHit& hit,
                     const Vec3& wo, const Vec3& normal, Sampler& sampler,
                     const IncomingRadiance& incoming, SingleScatterCounts& counts) {
    ++counts.samples;
    const MediumCoefficients medium(optics.material.medium);
    const float cosOut = glm::dot(normal, wo);
    const float cosOutInside = refractedCosine(cosOut, optics.eta);
    if (!(cosOut > 0 && cosOutInside > 0)) return Rgb(0);
    const Depth depth = sampleDepth(medium, sampler);
    if (isZero(depth.weight)) return Rgb(0);

    // A ray that leaves the body before it scatters brings nothing.
    Ray inward;
    inward.origin = world.leave(hit, -hit.geometricNormal);
    inward.direction =
        glm::normalize(refractedDirection(-wo, normal, cosOut, cosOutInside, optics.eta));
    inward.tMax = depth.distance;
    ++counts.rays;
    if (world.rays().occluded(inward, bodyMask(hit.body))) return Rgb(0);

    // From the surface itself: the step off it would count as distance in the medium.
    const Vec3 place = hit.position + inward.direction * depth.distance;
    const InScattering inside(world, optics, medium, hit.body, place, -inward.direction);
    const float leaving =
        (1.0f - fresnelReflectance(cosOut, optics.eta)) / (optics.eta * optics.eta);
    return inside.estimate(sampler, incoming, counts) * depth.weight * leaving;
}

}  // namespace sss
