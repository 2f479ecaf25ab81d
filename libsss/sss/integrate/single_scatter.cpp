#include "sss/integrate/single_scatter.h"

#include "sss/integrate/light_sampling.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/phase.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sss {
namespace {

// Beyond this many mean free paths nothing comes back: e^-16 = 1e-7.
constexpr float kDeepest = 16.0f;

struct Coefficients {
    Rgb sigmaS, sigmaT, g;
    explicit Coefficients(const Medium& medium)
        : sigmaS(medium.sigmaS), sigmaT(medium.sigmaA + medium.sigmaS), g(medium.g) {}
};

Rgb exponential(const Rgb& x) { return {std::exp(x.x), std::exp(x.y), std::exp(x.z)}; }

// A propagation direction bent at a boundary: `along` arrives against `normal`.
Vec3 refracted(const Vec3& along, const Vec3& normal, float cosOutside, float cosInside, float eta) {
    return along / eta + normal * (cosOutside / eta - cosInside);
}

// Where a straight line from inside meets the boundary on its way out.
struct Exit {
    Vec3 position, geometricNormal;
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
    exit.position = surface.position;
    exit.geometricNormal = surface.geometricNormal;
    exit.distance = hit.t;
    Vec3 normal = surface.shadingNormal;
    if (glm::dot(normal, direction) <= 0) normal = surface.geometricNormal;
    exit.cosOutside = glm::dot(normal, direction);
    exit.cosInside = refractedCosine(exit.cosOutside, optics.eta);
    if (!(exit.cosInside > 0)) return std::nullopt;  // eta < 1: no light comes in this way
    exit.inward = refracted(-direction, normal, exit.cosOutside, exit.cosInside, optics.eta);
    return exit;
}

// Everything on the way in but the light itself, towards the outgoing propagation direction `out`.
Rgb entering(const Coefficients& medium, const BodyOptics& optics, const Exit& exit,
             const Vec3& out) {
    const float cosTheta = std::clamp(glm::dot(exit.inward, out), -1.0f, 1.0f);
    const float snell = exit.cosOutside / exit.cosInside;
    const float boundary = (1.0f - fresnelReflectance(exit.cosOutside, optics.eta)) * snell;
    Rgb phase;
    for (int c = 0; c < 3; ++c) phase[c] = henyeyGreenstein(cosTheta, medium.g[c]);
    return phase * exponential(-medium.sigmaT * (exit.distance * snell)) * boundary;
}

struct Depth {
    float distance = 0;
    Rgb weight{0.0f};  // sigma_s e^{-sigma_t s} over the density of s
};

// Distance along the refracted ray, limited to `thickness`: a channel is picked, its extinction
// sampled, and the three ways to the same distance combined by the balance heuristic.
Depth sampleDepth(const Coefficients& medium, float thickness, Sampler& sampler) {
    const float pick = sampler.next1D(), u = sampler.next1D();
    const int channel = std::min(2, static_cast<int>(pick * 3.0f));
    const auto reach = [&](int c) { return -std::expm1(-medium.sigmaT[c] * thickness); };
    Depth depth;
    if (!(medium.sigmaT[channel] > 0)) return depth;
    depth.distance = std::min(thickness, -std::log1p(-u * reach(channel)) / medium.sigmaT[channel]);
    float density = 0;
    for (int c = 0; c < 3; ++c)
        if (medium.sigmaT[c] > 0)
            density +=
                medium.sigmaT[c] * std::exp(-medium.sigmaT[c] * depth.distance) / reach(c) / 3.0f;
    depth.weight = medium.sigmaS * exponential(-medium.sigmaT * depth.distance) / density;
    return depth;
}

Vec3 phaseDirection(const Vec3& axis, float g, const Vec2& u) {
    const float cosTheta = sampleHenyeyGreenstein(u.x, g);
    const float sinTheta = std::sqrt(std::max(0.0f, 1.0f - cosTheta * cosTheta));
    const float phi = 2.0f * kPiF * u.y;
    return Frame(axis).toWorld({sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta});
}

}  // namespace

Rgb singleScattering(const World& world, const BodyOptics& optics, const SurfaceHit& hit,
                     const Vec3& wo, const Vec3& normal, Sampler& sampler,
                     const IncomingRadiance& incoming, SingleScatterCounts& counts) {
    ++counts.samples;
    const Coefficients medium(optics.material.medium);
    const float cosOut = glm::dot(normal, wo);
    const float cosOutInside = refractedCosine(cosOut, optics.eta);
    if (!(cosOut > 0 && cosOutInside > 0)) return Rgb(0);
    const Vec3 down = glm::normalize(refracted(-wo, normal, cosOut, cosOutInside, optics.eta));
    const Vec3 inside = offsetFromSurface(hit.position, -hit.geometricNormal);

    // The ray stays inside for so long; far beyond the mean free path it does not matter where it ends.
    Ray through;
    through.origin = inside;
    through.direction = down;
    const float slowest = std::min({medium.sigmaT.x, medium.sigmaT.y, medium.sigmaT.z});
    if (slowest > 0) through.tMax = kDeepest / slowest;
    Hit end;
    ++counts.rays;
    float thickness = through.tMax;
    if (world.rays().intersect(through, end, bodyMask(hit.body))) thickness = end.t;
    if (std::isinf(thickness)) return Rgb(0);
    const Depth depth = sampleDepth(medium, thickness, sampler);
    if (isZero(depth.weight)) return Rgb(0);
    const Vec3 place = inside + down * depth.distance;

    const float meanG = meanComponent(medium.g);
    const float uPick = sampler.next1D();
    const Vec2 uLight = sampler.next2D(), uPhase = sampler.next2D();
    Rgb gathered(0);
    const DirectSample direct = sampleDirect(world, place, uPick, uLight);
    if (direct.pdf > 0) {
        ++counts.rays;
        const auto exit = findExit(world, optics, hit.body, place, direct.direction);
        if (exit && exit->distance < direct.distance) {
            DirectSample rest = direct;
            rest.distance -= exit->distance;
            ++counts.rays;
            if (isVisible(world, offsetFromSurface(exit->position, exit->geometricNormal), rest)) {
                const float phasePdf =
                    henyeyGreenstein(glm::dot(direct.direction, down), meanG);
                const float weight = direct.isDelta ? 1.0f : powerHeuristic(direct.pdf, phasePdf);
                gathered += entering(medium, optics, *exit, -down) * direct.radianceOverPdf * weight;
            }
        }
    }
    const Vec3 direction = phaseDirection(down, meanG, uPhase);
    const float phasePdf = henyeyGreenstein(glm::dot(direction, down), meanG);
    ++counts.rays;
    if (const auto exit = findExit(world, optics, hit.body, place, direction); exit && phasePdf > 0) {
        Ray outward;
        outward.origin = offsetFromSurface(exit->position, exit->geometricNormal);
        outward.direction = direction;
        ++counts.rays;
        gathered += entering(medium, optics, *exit, -down) * incoming(outward, place, phasePdf) /
                    phasePdf;
    }
    const float leaving = (1.0f - fresnelReflectance(cosOut, optics.eta)) / (optics.eta * optics.eta);
    return gathered * depth.weight * leaving;
}

}  // namespace sss
