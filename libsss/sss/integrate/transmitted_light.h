#pragma once
#include "sss/integrate/light_sampling.h"
#include "sss/integrate/medium_coefficients.h"

#include <span>

namespace sss {

/// A body as radiative transfer sees it.
struct BodyMedium {
    MediumCoefficients medium;
    float eta = 1;
    Vec3 centre{};     ///< of a ball around the body, in the world's space
    float radius = 0;  ///< mm
};

/// Share of the light of a DirectSample that reaches `from`, by channel: straight through bodies
/// whose index is that of their surroundings, by Beer and Lambert; nothing past opaque surfaces and
/// through bodies that refract. `body` is the one that `from` lies in, or -1; `rays` counts.
Rgb transmittedShare(const World& world, std::span<const BodyMedium> media, const Vec3& from,
                     const DirectSample& sample, int body, std::uint64_t& rays);

}  // namespace sss
