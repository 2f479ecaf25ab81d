#include "sss/integrate/spectral_weight.h"

#include <limits>

namespace sss {
namespace {

// e^{-sigma_t d} over that of the hero: all that counts, and free of underflow.
Rgb relativeTransmittance(const MediumCoefficients& medium, float distance, int hero) {
    return exponential((medium.sigmaT[hero] - medium.sigmaT) * distance);
}

}  // namespace

float sampleFreePath(const MediumCoefficients& medium, int hero, float u) {
    const float sigmaT = medium.sigmaT[hero];
    return sigmaT > 0 ? -std::log1p(-u) / sigmaT : std::numeric_limits<float>::infinity();
}

void passThrough(const MediumCoefficients& medium, float distanceMm, SpectralWeight& weight) {
    const Rgb passed = relativeTransmittance(medium, distanceMm, weight.hero());
    weight.choose(passed, passed);
}

void collide(const MediumCoefficients& medium, float distanceMm, SpectralWeight& weight) {
    const Rgb reached = relativeTransmittance(medium, distanceMm, weight.hero());
    weight.choose(medium.sigmaS * reached, medium.sigmaT * reached);
}

Vec3 scatter(const MediumCoefficients& medium, const Vec3& along, const Vec2& u,
             SpectralWeight& weight) {
    const Vec3 after = sampleScattered(along, medium.g[weight.hero()], u);
    if (medium.g.x != medium.g.y || medium.g.x != medium.g.z) {
        const Rgb phase = phaseBetween(medium, along, after);
        weight.choose(phase, phase);
    }
    return glm::normalize(after);
}

}  // namespace sss
