#include "sss/integrate/volume_passage.h"

#include "sss/integrate/arriving_light.h"
#include "sss/integrate/volume_lobes.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

// Share of the distances that are equiangular, where the light chosen has a place.
constexpr float kEquiangularShare = 0.5f;
// Share of the places that look for light by the phase function as well.
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

// Distances by extinction within the segment: a channel is picked, and the three balanced.
class ByExtinction {
public:
    explicit ByExtinction(const VolumeSegment& segment) : segment_(segment) {
        for (int c = 0; c < 3; ++c) {
            absorbed_[c] = -std::expm1(-segment.depth()[c]);
            if (absorbed_[c] > 0) usable_[count_++] = c;
        }
    }
    float sample(float u) const {
        const float scaled = u * static_cast<float>(count_);
        const int pick = std::min(count_ - 1, static_cast<int>(scaled));
        const int channel = usable_[pick];
        const float within = scaled - static_cast<float>(pick);
        return segment_.distanceAtDepth(channel, -std::log1p(-within * absorbed_[channel]));
    }
    float pdf(const Rgb& sigmaT, const Rgb& transmittance) const {
        float sum = 0;
        for (int k = 0; k < count_; ++k) {
            const int c = usable_[k];
            sum += sigmaT[c] * transmittance[c] / absorbed_[c];
        }
        return sum / static_cast<float>(count_);
    }

private:
    const VolumeSegment& segment_;
    Rgb absorbed_{0.0f};
    int usable_[3]{};
    int count_ = 0;
};

struct Place {
    float t = 0;
    Rgb weight{0.0f};  // transmittance over the density of t
};

Place samplePlace(const VolumeSegment& segment, const Ray& ray, const std::optional<Vec3>& centre,
                  Sampler& sampler) {
    const float pick = sampler.next1D(), u = sampler.next1D();
    const ByExtinction byExtinction(segment);
    const float equiangularShare = centre ? kEquiangularShare : 0.0f;
    std::optional<Equiangular> equiangular;
    if (centre) equiangular.emplace(ray, segment.begin(), segment.end(), *centre);
    Place place;
    place.t = pick < equiangularShare ? equiangular->sample(u) : byExtinction.sample(u);
    place.t = std::clamp(place.t, segment.begin(), segment.end());
    const Rgb transmittance = segment.transmittanceTo(place.t);
    float pdf = (1 - equiangularShare) * byExtinction.pdf(segment.sigmaT(place.t), transmittance);
    if (centre) pdf += equiangularShare * equiangular->pdf(place.t);
    if (pdf > 0 && std::isfinite(pdf)) place.weight = transmittance / pdf;
    return place;
}

Rgb inScattered(const World& world, const VolumeSegment& segment, const Ray& ray, Sampler& sampler,
                const IncomingRadiance& incoming, std::uint64_t& rays) {
    const LightPicker& picker = world.picker();
    const float uPick = sampler.next1D();
    LightPicker::Pick pick{};
    std::optional<Vec3> centre;
    if (!picker.empty()) {
        pick = picker.pick(uPick);
        centre = world.lights()[pick.index]->centre();
    }
    const Place place = samplePlace(segment, ray, centre, sampler);
    const Vec2 uLight = sampler.next2D(), uPhase = sampler.next2D();
    const float uLobe = sampler.next1D(), uTechnique = sampler.next1D();
    const VolumeLobes lobes(segment, place.t);
    if (lobes.isEmpty() || isZero(place.weight)) return Rgb(0);
    const Vec3 from = ray.at(place.t);

    // Light goes against the path: its cosine is that of the path's own directions.
    Rgb sum(0);
    const DirectSample direct =
        picker.empty() ? DirectSample{} : sampleDirect(world, pick, from, uLight);
    if (direct.pdf > 0) {
        const float cosine = glm::dot(direct.direction, ray.direction);
        const float weight = direct.isDelta ? 1.0f : powerHeuristic(direct.pdf, lobes.pdf(cosine));
        sum += lobes.value(cosine) * direct.radianceOverPdf * weight *
               arrivingShare(world, shadowRay(from, direct), direct, rays);
    }
    if (uTechnique < kPhaseShare) {
        Ray next;
        next.origin = from;
        next.direction = lobes.sample(ray.direction, uLobe, uPhase);
        const float cosine = glm::dot(next.direction, ray.direction);
        const float pdf = lobes.pdf(cosine);
        if (pdf > 0) sum += lobes.value(cosine) / (pdf * kPhaseShare) * incoming(next, from, pdf);
    }
    return sum * place.weight;
}

}  // namespace

VolumePassage passVolumes(const World& world, const PathStretch& stretch, Sampler& sampler,
                          const IncomingRadiance& incoming, std::uint64_t& rays) {
    VolumePassage passage;
    const VolumeSegment segment = world.volumesAlong(stretch.ray, stretch.distance);
    if (segment.isEmpty()) return passage;
    passage.transmittance = segment.transmittance();
    passage.radiance = radianceOfVolumes(world, segment, stretch.ray, stretch.origin);
    if (segment.scatters() && !stretch.origin.afterVolume)
        passage.radiance += inScattered(world, segment, stretch.ray, sampler, incoming, rays);
    return passage;
}

}  // namespace sss
