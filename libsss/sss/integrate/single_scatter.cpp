#include "sss/integrate/single_scatter.h"

#include "sss/base/warp.h"
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

struct Depth {
    float distance = 0;
    Rgb weight{0.0f};  // sigma_s e^{-sigma_t s} over the density of s
};

// Share of the samples that reckon with the way in too.
constexpr float kBothWaysShare = 0.5f;

// Distance along the refracted ray. A channel is picked and its extinction sampled: half the time
// that of the way out and of the way in together, which is `both` times the former under a flat
// surface, for light at a usual angle; else that of the way out alone, lest light that comes
// through a thin part gets too large a weight. The six ways to the same distance are combined by
// the balance heuristic.
Depth sampleDepth(const MediumCoefficients& medium, float both, Sampler& sampler) {
    const float pick = 3.0f * sampler.next1D(), u = sampler.next1D();
    const int channel = std::min(2, static_cast<int>(pick));
    const bool countsBoth = pick - static_cast<float>(channel) < kBothWaysShare;
    Depth depth;
    if (!(medium.sigmaT[channel] > 0)) return depth;
    depth.distance = -std::log1p(-u) / (medium.sigmaT[channel] * (countsBoth ? both : 1.0f));
    const Rgb out = medium.transmittance(depth.distance);
    const Rgb outAndIn = medium.transmittance(depth.distance * both);
    const float density = meanComponent(
        medium.sigmaT * (kBothWaysShare * both * outAndIn + (1 - kBothWaysShare) * out));
    if (density > 0) depth.weight = medium.sigmaS * out / density;
    return depth;
}

// By how much the way out and the way in together dim more than the way out alone, under a flat
// surface seen at an inner cosine of `cosOutInside`: refraction bends all light towards the normal,
// so that one angle of the way in stands for all.
float bothWays(float cosOutInside, float eta) {
    constexpr float kUsualCosine = 2.0f / 3.0f;
    return 1.0f + cosOutInside / std::max(0.5f, refractedCosine(kUsualCosine, eta));
}

// Share of the samples that look for light by light sampling: less where the lights can shine only
// from behind, through the body. The others sample where light may come from.
constexpr float kLightShare = 0.75f, kLightShareBehind = 0.5f;

// Whether a lamp stands above the surface there.
bool isLitFromOutside(const World& world, const SurfaceHit& hit) {
    return std::ranges::any_of(world.lights(), [&](const auto& light) {
        return !light->bestFoundByScattering() &&
               !light->isBelow(hit.position, hit.geometricNormal);
    });
}

float lightShare(const World& world, bool isLit) {
    if (world.picker().empty()) return 0;
    return isLit ? kLightShare : kLightShareBehind;
}

// Share of those others that go out through the surface they came in by; the rest sample the phase
// function.
constexpr float kOutwardShare = 0.75f;

// Of light whose way in leaves less of it than this (sr^-1), a hundredth of what isotropic
// scattering turns towards the camera, not all is followed.
constexpr float kFaint = 0.01f / (4 * kPiF);

// What a place inside sends towards the outgoing propagation direction `out`, by one of the two
// techniques, weighted by the power heuristic for one sample.
class InScattering {
public:
    InScattering(const World& world, const BodyOptics& optics, const MediumCoefficients& medium,
                 const SurfaceHit& hit, bool isLit, const Vec3& place, const Vec3& out)
        : world_(world),
          optics_(optics),
          medium_(medium),
          body_(hit.body),
          outward_(hit.geometricNormal),
          lightShare_(lightShare(world, isLit)),
          place_(place),
          out_(out) {}

    Rgb estimate(Sampler& sampler, const IncomingRadiance& incoming,
                 SingleScatterCounts& counts) const {
        const float uTechnique = sampler.next1D(), uPick = sampler.next1D();
        const Vec2 u = sampler.next2D();
        const float uFaint = sampler.next1D();
        if (uTechnique < lightShare_) return byLight(uPick, u, uFaint, counts);
        const float rest = (uTechnique - lightShare_) / (1 - lightShare_);
        return byScattering(rest < kOutwardShare, u, uFaint, incoming, counts);
    }

private:
    // Everything on the way in but the light itself. What is left of faint light is followed by
    // chance, and zero where chance says no.
    Rgb entering(const Exit& exit, float uFaint) const {
        const float snell = exit.cosOutside / exit.cosInside;
        const float boundary = (1.0f - fresnelReflectance(exit.cosOutside, optics_.eta)) * snell;
        const Rgb share = phaseBetween(medium_, exit.inward, out_) *
                          medium_.transmittance(exit.distance * snell) * boundary;
        const float survival = std::min(1.0f, maxComponent(share) / kFaint);
        return uFaint < survival ? share / survival : Rgb(0);
    }

    // Density of byScattering().
    float scatteringPdf(const Vec3& direction) const {
        const float phase = henyeyGreenstein(-glm::dot(direction, out_), meanComponent(medium_.g));
        const float outward = std::max(0.0f, glm::dot(direction, outward_.normal)) / kPiF;
        return (1 - lightShare_) * (kOutwardShare * outward + (1 - kOutwardShare) * phase);
    }

    Rgb byLight(float uPick, const Vec2& u, float uFaint, SingleScatterCounts& counts) const {
        const DirectSample direct = sampleDirect(world_, place_, uPick, u);
        if (!(direct.pdf > 0)) return Rgb(0);
        ++counts.rays;
        const auto exit = findExit(world_, optics_, body_, place_, direct.direction);
        if (!exit || exit->distance >= direct.distance) return Rgb(0);
        const Rgb wayIn = entering(*exit, uFaint);
        if (isZero(wayIn)) return Rgb(0);
        DirectSample rest = direct;
        rest.distance -= exit->distance;
        const Rgb arriving = arrivingShare(world_, exit->outside, rest, counts.rays);
        if (isZero(arriving)) return Rgb(0);
        const float weight = direct.isDelta ? 1.0f
                                            : powerHeuristic(lightShare_ * direct.pdf,
                                                             scatteringPdf(direct.direction));
        return wayIn * arriving * direct.radianceOverPdf * (weight / lightShare_);
    }

    Rgb byScattering(bool outward, const Vec2& u, float uFaint, const IncomingRadiance& incoming,
                     SingleScatterCounts& counts) const {
        const Vec3 direction = outward ? outward_.toWorld(cosineDirection(u))
                                       : sampleScattered(-out_, meanComponent(medium_.g), u);
        const float pdf = scatteringPdf(direction);
        if (!(pdf > 0)) return Rgb(0);
        ++counts.rays;
        const auto exit = findExit(world_, optics_, body_, place_, direction);
        if (!exit) return Rgb(0);
        const Rgb wayIn = entering(*exit, uFaint);
        if (isZero(wayIn)) return Rgb(0);
        Ray beyond;
        beyond.origin = exit->outside;
        beyond.direction = direction;
        // Infinite without light sampling: nothing to share with.
        return wayIn * incoming(beyond, place_, pdf / lightShare_) / pdf;
    }

    const World& world_;
    const BodyOptics& optics_;
    const MediumCoefficients& medium_;
    int body_;
    Frame outward_;
    float lightShare_;
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
    // Light that comes only from behind goes the other way through a thin part: less of it is left
    // where it came in, not more.
    const bool isLit = isLitFromOutside(world, hit);
    const float both = isLit ? bothWays(cosOutInside, optics.eta) : 1.0f;
    const Depth depth = sampleDepth(medium, both, sampler);
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
    const InScattering inside(world, optics, medium, hit, isLit, place, -inward.direction);
    const float leaving =
        (1.0f - fresnelReflectance(cosOut, optics.eta)) / (optics.eta * optics.eta);
    return inside.estimate(sampler, incoming, counts) * depth.weight * leaving;
}

}  // namespace sss
