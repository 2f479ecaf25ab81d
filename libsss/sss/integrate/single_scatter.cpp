#include "sss/integrate/single_scatter.h"

#include "sss/base/assert.h"
#include "sss/base/inline_vector.h"
#include "sss/base/warp.h"
#include "sss/integrate/arriving_light.h"
#include "sss/integrate/medium_coefficients.h"
#include "sss/integrate/smooth_boundary.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/phase.h"

#include <algorithm>
#include <array>
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

std::optional<Exit> exitAt(const World& world, const SingleQuery& query, const Vec3& direction,
                           const Hit& hit) {
    const SurfaceHit surface = world.surfaceAt(hit);
    if (surface.body != query.hit->body || glm::dot(surface.geometricNormal, direction) <= 0)
        return std::nullopt;
    const float eta = query.optics->eta;
    Exit exit;
    exit.outside = world.leave(surface, surface.geometricNormal);
    exit.distance = hit.t;
    Vec3 normal = surface.shadingNormal;
    if (glm::dot(normal, direction) <= 0) normal = surface.geometricNormal;
    exit.cosOutside = glm::dot(normal, direction);
    exit.cosInside = refractedCosine(exit.cosOutside, eta);
    if (!(exit.cosInside > 0)) return std::nullopt;  // eta < 1: no light comes in this way
    exit.inward = refractedDirection(-direction, normal, exit.cosOutside, exit.cosInside, eta);
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
    const Vec2 numbers = sampler.next2D();
    const float pick = 3.0f * numbers.x, u = numbers.y;
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

// What a place inside sends out towards where it is seen from, by one of the two techniques,
// weighted by the power heuristic for one sample.
class InScattering {
public:
    // `lightShare` of the samples are by light sampling; `inward` leads to the place from where it
    // is seen, `leaving` by how much.
    InScattering(SingleQuery& query, const MediumCoefficients& medium, float lightShare,
                 const Vec3& place, const Ray& inward, const Rgb& leaving)
        : query_(query),
          medium_(medium),
          outward_(query.hit->geometricNormal),
          lightShare_(lightShare),
          place_(place),
          out_(-inward.direction),
          inward_(inward),
          leaving_(leaving) {}

    const SingleQuery& query() const { return query_; }
    // A ray that leaves the body before it scatters brings nothing.
    const Ray& inward() const { return inward_; }

    // Chooses a technique: a light to be sampled from the place, or none for the other one, which
    // chooses its direction itself.
    std::optional<LightQuery> choose(const World& world) {
        Sampler& sampler = query_.sampler;
        const Vec2 pick = sampler.next2D();  // technique, light
        const Vec2 u = sampler.next2D();
        uFaint_ = sampler.next1D();
        isByLight_ = pick.x < lightShare_;
        if (isByLight_) return LightQuery{world.picker().pick(pick.y), place_, u};
        const bool outward = (pick.x - lightShare_) / (1 - lightShare_) < kOutwardShare;
        direct_.direction = outward ? outward_.toWorld(cosineDirection(u))
                                    : sampleScattered(-out_, meanComponent(medium_.g), u);
        direct_.pdf = scatteringPdf(direct_.direction);
        return std::nullopt;
    }
    void setLight(const DirectSample& sample) { direct_ = sample; }

    // A straight line to the boundary in the direction that was chosen; false if there is none.
    bool aim(Ray& line) const {
        line.origin = place_;
        line.direction = direct_.direction;
        return direct_.pdf > 0;
    }

    // What light sampling brings where its line goes out, if nothing stands on the way `shadow`;
    // zero for the other technique, whose ray this tells.
    Rgb gather(const Exit& exit, Ray& shadow, SingleFound& found) const {
        if (isByLight_ && exit.distance >= direct_.distance) return Rgb(0);
        const Rgb wayIn = entering(exit) * leaving_;
        if (isZero(wayIn)) return Rgb(0);
        if (!isByLight_) {
            found.weight = wayIn / direct_.pdf;
            found.ray.origin = exit.outside;
            found.ray.direction = direct_.direction;
            // Infinite without light sampling: nothing to share with.
            found.origin = {place_, direct_.pdf / lightShare_};
            return Rgb(0);
        }
        DirectSample rest = direct_;
        rest.distance -= exit.distance;
        shadow = shadowRay(exit.outside, rest);
        const float weight = direct_.isDelta ? 1.0f
                                             : powerHeuristic(lightShare_ * direct_.pdf,
                                                              scatteringPdf(direct_.direction));
        return wayIn * direct_.radianceOverPdf * (weight / lightShare_);
    }
    int volume() const { return direct_.volume; }

private:
    // Everything on the way in but the light itself. What is left of faint light is followed by
    // chance, and zero where chance says no.
    Rgb entering(const Exit& exit) const {
        const float snell = exit.cosOutside / exit.cosInside;
        const float boundary =
            (1.0f - fresnelReflectance(exit.cosOutside, query_.optics->eta)) * snell;
        const Rgb share = phaseBetween(medium_, exit.inward, out_) *
                          medium_.transmittance(exit.distance * snell) * boundary;
        const float survival = std::min(1.0f, maxComponent(share) / kFaint);
        return uFaint_ < survival ? share / survival : Rgb(0);
    }

    // Density of the directions that are not chosen by light sampling.
    float scatteringPdf(const Vec3& direction) const {
        const float phase = henyeyGreenstein(-glm::dot(direction, out_), meanComponent(medium_.g));
        const float outward = std::max(0.0f, glm::dot(direction, outward_.normal)) / kPiF;
        return (1 - lightShare_) * (kOutwardShare * outward + (1 - kOutwardShare) * phase);
    }

    SingleQuery& query_;
    MediumCoefficients medium_;
    Frame outward_;
    float lightShare_;
    Vec3 place_, out_;  // out: the propagation direction in which it is seen
    Ray inward_;
    Rgb leaving_;
    DirectSample direct_;  // of the other technique, direction and density only
    float uFaint_ = 0;
    bool isByLight_ = false;
};

// Where light might scatter towards where a place is seen from.
std::optional<InScattering> scatteringPlace(const World& world, SingleQuery& query) {
    const MediumCoefficients medium(query.optics->material.medium);
    const float eta = query.optics->eta, cosOut = glm::dot(query.normal, query.wo);
    const float cosOutInside = refractedCosine(cosOut, eta);
    if (!(cosOut > 0 && cosOutInside > 0)) return std::nullopt;
    // Light that comes only from behind goes the other way through a thin part: less of it is left
    // where it came in, not more.
    const bool isLit = isLitFromOutside(world, *query.hit);
    const Depth depth =
        sampleDepth(medium, isLit ? bothWays(cosOutInside, eta) : 1.0f, query.sampler);
    if (isZero(depth.weight)) return std::nullopt;
    Ray inward;
    inward.origin = world.leave(*query.hit, -query.hit->geometricNormal);
    inward.direction =
        glm::normalize(refractedDirection(-query.wo, query.normal, cosOut, cosOutInside, eta));
    inward.tMax = depth.distance;
    // From the surface itself: the step off it would count as distance in the medium.
    const Vec3 place = query.hit->position + inward.direction * depth.distance;
    const float leaving = (1.0f - fresnelReflectance(cosOut, eta)) / (eta * eta);
    return InScattering(query, medium, lightShare(world, isLit), place, inward,
                        depth.weight * leaving);
}

template <typename T>
using SingleList = InlineVector<T, kMostSingle>;

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

void singleScattering(const World& world, std::span<SingleQuery> queries,
                      std::span<SingleFound> found, SingleScatterCounts& counts) {
    SSS_ASSERT_LE(queries.size(), kMostSingle);
    counts.samples += queries.size();
    SingleList<InScattering> insides;
    for (SingleQuery& query : queries)
        if (const auto inside = scatteringPlace(world, query)) insides.add(*inside);

    SingleList<LightQuery> lights;
    SingleList<InScattering*> asking;  // by light
    for (InScattering& inside : insides.span()) {
        const auto light = inside.choose(world);
        if (!light) continue;
        lights.add(*light);
        asking.add(&inside);
    }
    std::array<DirectSample, kMostSingle> samples;
    sampleDirect(world, lights.span(), samples);
    for (std::size_t k = 0; k < lights.size(); ++k) asking[k]->setLight(samples[k]);

    SingleList<const InScattering*> aimed;  // by line
    SingleList<Ray> lines;
    SingleList<std::uint32_t> masks;
    SingleList<Hit> hits;
    for (const InScattering& inside : insides.span()) {
        Ray line;
        if (!inside.aim(line)) continue;
        aimed.add(&inside);
        lines.add(line);
        masks.add(bodyMask(inside.query().hit->body));
        hits.add();
    }
    world.rays().intersectTogether(lines.span(), RayScene::Together::Parted, hits.span(),
                                   masks.span());
    counts.rays += lines.size();

    // What is found, if the body reaches as far as the place and nothing stands on the way to the
    // light: asked last, both at once, when there is little left to ask for.
    struct Promise {
        SingleFound* found;
        std::size_t inward, shadow;  // rays; the same if there is no shadow ray
    };
    SingleList<Promise> promises;
    InlineVector<Ray, 2 * kMostSingle> ways;
    InlineVector<std::uint32_t, 2 * kMostSingle> wayMasks;
    for (std::size_t i = 0; i < aimed.size(); ++i) {
        if (hits[i].geometry == kNoGeometry) continue;
        const InScattering& inside = *aimed[i];
        const auto exit = exitAt(world, inside.query(), lines[i].direction, hits[i]);
        if (!exit) continue;
        SingleFound& here = found[static_cast<std::size_t>(&inside.query() - queries.data())];
        Ray shadow;
        here.radiance = inside.gather(*exit, shadow, here);
        if (isZero(here.radiance) && isZero(here.weight)) continue;
        const std::size_t inward = ways.size();
        ways.add(inside.inward());
        wayMasks.add(masks[i]);
        if (!isZero(here.radiance) && world.hasVolumes())
            here.radiance *= arrivingShare(world, shadow, inside.volume(), counts.rays);
        else if (!isZero(here.radiance)) {
            ways.add(shadow);
            wayMasks.add(kAllGeometry);
        }
        promises.add(Promise{&here, inward, ways.size() - 1});
    }
    std::array<bool, 2 * kMostSingle> blocked;
    world.rays().occludedTogether(ways.span(), RayScene::Together::Parted, blocked,
                                  wayMasks.span());
    counts.rays += ways.size();
    for (const Promise& promise : promises.span())
        if (blocked[promise.inward] || blocked[promise.shadow]) *promise.found = {};
}

Rgb singleScattering(const World& world, const BodyOptics& optics, const SurfaceHit& hit,
                     const Vec3& wo, const Vec3& normal, Sampler& sampler,
                     const IncomingRadiance& incoming, SingleScatterCounts& counts) {
    SingleQuery query{&optics, &hit, wo, normal, sampler};
    SingleFound found;
    singleScattering(world, std::span(&query, 1), std::span(&found, 1), counts);
    sampler = query.sampler;
    if (isZero(found.weight)) return found.radiance;
    return found.radiance +
           found.weight * incoming(found.ray, found.origin.sampledFrom, found.origin.pdf);
}

}  // namespace sss
