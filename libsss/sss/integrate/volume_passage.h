#pragma once
#include "sss/integrate/light_sampling.h"
#include "sss/integrate/single_scatter.h"

namespace sss {

/// What volumes do to light along one stretch of a path.
struct VolumePassage {
    Rgb radiance{0.0f};       ///< what they add, at the stretch's origin
    Rgb transmittance{1.0f};  ///< what they leave of what comes from beyond
};

/// Where a stretch of a path runs, and how it came about.
struct PathStretch {
    Ray ray;
    float distance = 0;  ///< to the surface at its end, or infinite
    ScatterOrigin origin;
};

/// Attenuation and emission exactly, and light scattered once [Koutajoki Eq. 4], unless the stretch
/// begins after such a scattering: of light that volumes scatter more than once only the integrator
/// "volume" knows. A light is picked and looked for from a place where it shines, sampled by its
/// distance from the light (equiangular [Kulla and Fajardo 2012, "Importance Sampling Techniques
/// for Path Tracing in Participating Media"]) or by the extinction of one of the channels,
/// balanced; at another place, sampled by extinction, the phase function looks for light. What both
/// find is weighted by the power heuristic. `incoming` is the radiance that arrives at the place;
/// `rays` counts shadow rays.
VolumePassage passVolumes(const World& world, const PathStretch& stretch, Sampler& sampler,
                          const IncomingRadiance& incoming, std::uint64_t& rays);

}  // namespace sss
