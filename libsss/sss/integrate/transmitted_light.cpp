#include "sss/integrate/transmitted_light.h"

namespace sss {

Rgb transmittedShare(const World& world, std::span<const BodyMedium> media, const MediumPlace& from,
                     const DirectSample& sample, std::uint64_t& rays) {
    int body = from.body;
    Rgb share(1), emitted(0);
    Ray ray = shadowRay(from.position, sample);
    const float end = ray.tMax;
    Hit found;
    Vec3 start = from.position;
    const auto crossSpace = [&](float distance) {
        if (body >= 0 || !world.hasVolumes()) return;
        const VolumeSegment volumes = world.volumesAlong(ray, distance);
        if (sample.volume >= 0)
            emitted += share * volumes.emission(static_cast<std::size_t>(sample.volume));
        share *= volumes.transmittance();
    };
    while (++rays, world.rays().intersect(ray, found)) {
        crossSpace(found.t);
        const SurfaceHit hit = world.surfaceAt(found);
        if (hit.body < 0 || media[static_cast<std::size_t>(hit.body)].eta != 1.0f) return emitted;
        const bool leaving = glm::dot(hit.geometricNormal, ray.direction) > 0;
        if (leaving && body == hit.body)
            share *= media[static_cast<std::size_t>(body)].medium.transmittance(
                glm::distance(start, hit.position));
        body = leaving ? -1 : hit.body;
        start = hit.position;
        ray.origin = world.leave(hit, leaving ? hit.geometricNormal : -hit.geometricNormal);
        ray.tMax = end - glm::distance(from.position, ray.origin);
        if (!(ray.tMax > 0)) break;
    }
    crossSpace(ray.tMax);
    if (sample.volume >= 0) return emitted;
    // A light inside a body is not seen from there: paths do not look for lights on their way.
    return body >= 0 && std::isfinite(sample.distance) ? Rgb(0) : share;
}

}  // namespace sss
