#pragma once
#include "sss/medium/medium.h"

namespace sss {

inline Rgb exponential(const Rgb& x) { return {std::exp(x.x), std::exp(x.y), std::exp(x.z)}; }

/// A medium as light transport uses it: by channel in float, mm^-1.
struct MediumCoefficients {
    Rgb sigmaS, sigmaT, g;
    explicit MediumCoefficients(const Medium& medium)
        : sigmaS(medium.sigmaS), sigmaT(medium.sigmaA + medium.sigmaS), g(medium.g) {}

    Rgb transmittance(float distanceMm) const { return exponential(-sigmaT * distanceMm); }
};

/// A propagation direction after scattering from `along`, Henyey-Greenstein distributed.
Vec3 sampleScattered(const Vec3& along, float g, const Vec2& u);
/// Phase function between two propagation directions, by channel, sr^-1.
Rgb phaseBetween(const MediumCoefficients& medium, const Vec3& before, const Vec3& after);

}  // namespace sss
