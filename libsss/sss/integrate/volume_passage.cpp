#include "sss/integrate/volume_passage.h"

#include "sss/integrate/arriving_light.h"
#include "sss/integrate/medium_coefficients.h"
#include "sss/integrate/volume_lobes.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

// Share of the distances that are equiangular, where the light chosen has a place.
constexpr float kEquiangularShare = 0.5f;
// Share of the stretches that look for light by the phase function as well.
constexpr float kPhaseShare = 0.5f;

// Distances along a line in proportion to the inverse square of the distance from a point.
class Equiangular {
public:
    Equiangular(const Ray& ray, float begin, float end, const Vec3& point)
        : nearest_(glm::dot(point - ray.origin, ray.direction)),
          // Not through the point itself, where one angle has all distances.
          aside_(std::max(glm::distance(point, ray.at(nearest_)), 1e-4f * (end - begin))),
          first_(std::atan((begin - nearest_) / aside_)),
          angle_(std::atan((end - nearest_) / aside_) - first_) {}

    float sample(float u) const { return nearest_ + aside_ * std::tan(first_ + u * angle_); }
    float pdf(float t) const {
        const float along = t - nearest_;
        return aside_ / (angle_ * (aside_ * aside_ + along * along));
    }

private:
    float nearest_, aside_, first_, angle_;
};

// Distances by extinction within a part of the segment: a channel is picked, and the three
// balanced.
class ByExtinction {
public:
    ByExtinction(const VolumeSegment& segment, const Light::Stretch& part)
        : segment_(segment), before_(segment.depthTo(part.begin)) {
        const Rgb depth = segment.depthTo(part.end) - before_;
        for (int c = 0; c < 3; ++c) {
            absorbed_[c] = -std::expm1(-depth[c]);
            if (absorbed_[c] > 0) usable_[count_++] = c;
        }
    }
    float sample(float u) const {
        const float scaled = u * static_cast<float>(count_);
        const int pick = std::min(count_ - 1, static_cast<int>(scaled));
        const int channel = usable_[pick];
        const float within = scaled - static_cast<float>(pick);
        const float depth = before_[channel] - std::log1p(-within * absorbed_[channel]);
        return segment_.distanceAtDepth(channel, depth);
    }
    float pdf(float t, const Rgb& depth) const {
        const Rgb sigmaT = segment_.sigmaT(t);
        float sum = 0;
        for (int k = 0; k < count_; ++k) {
            const int c = usable_[k];
            sum += sigmaT[c] * std::exp(before_[c] - depth[c]) / absorbed_[c];
        }
        return sum / static_cast<float>(count_);
    }
    bool isEmpty() const { return count_ == 0; }

private:
    const VolumeSegment& segment_;
    Rgb before_, absorbed_{0.0f};
    int usable_[3]{};
    int count_ = 0;
};

struct Place {
    float t = 0;
    Rgb weight{0.0f};  // transmittance over the density of t
};

// A place on a part of the segment, for light that falls off with its distance from `centre`.
Place samplePlace(const VolumeSegment& segment, const Ray& ray, const Light::Stretch& part,
                  const std::optional<Vec3>& centre, const Vec2& u) {
    Place place;
    const ByExtinction byExtinction(segment, part);
    if (!(part.begin < part.end) || byExtinction.isEmpty()) return place;
    const float share = centre ? kEquiangularShare : 0.0f;
    std::optional<Equiangular> equiangular;
    if (centre) equiangular.emplace(ray, part.begin, part.end, *centre);
    place.t = u.x < share ? equiangular->sample(u.y) : byExtinction.sample(u.y);
    place.t = std::clamp(place.t, part.begin, part.end);
    const Rgb depth = segment.depthTo(place.t);
    float pdf = (1 - share) * byExtinction.pdf(place.t, depth);
    if (centre) pdf += share * equiangular->pdf(place.t);
    if (pdf > 0 && std::isfinite(pdf)) place.weight = exponential(-depth) / pdf;
    return place;
}

// By light sampling. Light goes against the path: its cosine is that of the path's own directions.
Rgb scatteredFromLight(const World& world, const VolumeSegment& segment, const Ray& ray,
                       Sampler& sampler, std::uint64_t& rays) {
    const LightPicker::Pick pick = world.picker().pick(sampler.next1D());
    const Light& light = *world.lights()[pick.index];
    const Light::Stretch lit =
        light.litStretch(ray.origin, ray.direction, {segment.begin(), segment.end()});
    const Place place = samplePlace(segment, ray, lit, light.centre(), sampler.next2D());
    const Vec2 uLight = sampler.next2D();
    if (isZero(place.weight)) return Rgb(0);
    const VolumeLobes lobes(segment, place.t);
    if (lobes.isEmpty()) return Rgb(0);
    const Vec3 from = ray.at(place.t);
    const DirectSample direct = sampleDirect(world, pick, from, uLight);
    if (!(direct.pdf > 0)) return Rgb(0);
    const float cosine = glm::dot(direct.direction, ray.direction);
    const float weight = direct.isDelta ? 1.0f : powerHeuristic(direct.pdf, lobes.pdf(cosine));
    return place.weight * lobes.value(cosine) * direct.radianceOverPdf * weight *
           arrivingShare(world, from, direct, rays);
}

// By the phase function: lights that it finds better, and light from surfaces.
Rgb scatteredFromAround(const VolumeSegment& segment, const Ray& ray, Sampler& sampler,
                        const IncomingRadiance& incoming) {
    const Place place =
        samplePlace(segment, ray, {segment.begin(), segment.end()}, {}, sampler.next2D());
    const Vec2 uPhase = sampler.next2D();
    const float uLobe = sampler.next1D();
    if (isZero(place.weight)) return Rgb(0);
    const VolumeLobes lobes(segment, place.t);
    if (lobes.isEmpty()) return Rgb(0);
    Ray next;
    next.origin = ray.at(place.t);
    next.direction = lobes.sample(ray.direction, uLobe, uPhase);
    const float cosine = glm::dot(next.direction, ray.direction), pdf = lobes.pdf(cosine);
    if (!(pdf > 0)) return Rgb(0);
    return place.weight * lobes.value(cosine) * incoming(next, next.origin, pdf) / pdf;
}

}  // namespace

VolumePassage passVolumes(const World& world, const PathStretch& stretch, Sampler& sampler,
                          const IncomingRadiance& incoming, std::uint64_t& rays) {
    VolumePassage passage;
    const VolumeSegment segment = world.volumesAlong(stretch.ray, stretch.distance);
    if (segment.isEmpty()) return passage;
    passage.transmittance = segment.transmittance();
    passage.radiance = radianceOfVolumes(world, segment, stretch.ray, stretch.origin);
    if (!segment.scatters() || stretch.origin.afterVolume) return passage;
    if (!world.picker().empty())
        passage.radiance += scatteredFromLight(world, segment, stretch.ray, sampler, rays);
    if (sampler.next1D() < kPhaseShare)
        passage.radiance +=
            scatteredFromAround(segment, stretch.ray, sampler, incoming) / kPhaseShare;
    return passage;
}

}  // namespace sss
