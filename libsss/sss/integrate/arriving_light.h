#pragma once
#include "sss/integrate/light_sampling.h"

namespace sss {

/// What of the light of a DirectSample arrives along its shadow ray, to be multiplied by its
/// radianceOverPdf: nothing past a surface; what the volumes on the way leave of it; for a glowing
/// `volume` (see DirectSample), its emission up to the first surface. `rays` counts.
Rgb arrivingShare(const World& world, const Ray& shadow, int volume, std::uint64_t& rays);
/// The same from a point that is already off its surface.
inline Rgb arrivingShare(const World& world, const Vec3& from, const DirectSample& sample,
                         std::uint64_t& rays) {
    return arrivingShare(world, shadowRay(from, sample), sample.volume, rays);
}

/// Radiance that glowing volumes send along a ray from where it ends back to its origin, each
/// weighted against light sampling; `segment` is that of the ray.
Rgb radianceOfVolumes(const World& world, const VolumeSegment& segment, const Ray& ray,
                      const ScatterOrigin& origin);

}  // namespace sss
