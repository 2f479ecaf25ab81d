#include "sss/integrate/arriving_light.h"

namespace sss {

Rgb arrivingShare(const World& world, const Ray& shadow, int volume, std::uint64_t& rays) {
    ++rays;
    if (volume >= 0) {
        Hit hit;
        const float end = world.rays().intersect(shadow, hit) ? hit.t : shadow.tMax;
        return world.volumesAlong(shadow, end).emission(static_cast<std::size_t>(volume));
    }
    if (world.rays().occluded(shadow)) return Rgb(0);
    return world.hasVolumes() ? world.volumesAlong(shadow, shadow.tMax).transmittance() : Rgb(1);
}

Rgb radianceOfVolumes(const World& world, const VolumeSegment& segment, const Ray& ray,
                      const ScatterOrigin& origin) {
    Rgb sum(0);
    for (std::size_t v = 0; v < world.volumes().size(); ++v) {
        const VolumeLight* glow = world.glow(v);
        if (!glow) continue;
        const Rgb emission = segment.emission(v);
        if (isZero(emission)) continue;
        float weight = 1;
        if (std::isfinite(origin.pdf))
            weight = powerHeuristic(origin.pdf, glow->pdf(origin.sampledFrom, ray.direction) *
                                                    world.picker().pmf(world.glowIndex(v)));
        sum += emission * weight;
    }
    return sum;
}

}  // namespace sss
