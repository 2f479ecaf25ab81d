#pragma once
#include "sss/integrate/light_sampling.h"
#include "sss/integrate/medium_coefficients.h"
#include "sss/optics/microfacet.h"

#include <span>

namespace sss {

/// A body as radiative transfer sees it.
struct BodyMedium {
    MediumCoefficients medium;
    float eta = 1;
    Ggx boundary{0};
    bool samplesLights = false;  ///< at its boundary: those that no path finds
    Vec3 centre{};               ///< of a ball around the body, in the world's space
    float radius = 0;            ///< mm
};

/// A place in space, or in the medium of a body.
struct MediumPlace {
    Vec3 position{};
    int body = -1;  ///< -1 in space
};

/// Share of the light of a DirectSample that reaches `from`, by channel: straight through volumes
/// and bodies whose index is that of their surroundings, by Beer and Lambert; nothing past opaque
/// surfaces and through bodies that refract. For a glowing volume, its emission on that way.
/// `media` by body; counts into `rays`.
Rgb transmittedShare(const World& world, std::span<const BodyMedium> media, const MediumPlace& from,
                     const DirectSample& sample, std::uint64_t& rays);

}  // namespace sss
