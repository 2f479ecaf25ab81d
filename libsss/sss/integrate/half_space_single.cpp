#include "sss/integrate/half_space_single.h"

#include "sss/optics/fresnel.h"
#include "sss/optics/refraction.h"

namespace sss {

Rgb halfSpaceSingleScattering(const MediumCoefficients& medium, float eta, const Vec3& wo,
                              const Vec3& wi) {
    if (!(wo.z > 0 && wi.z > 0)) return Rgb(0);
    const float muO = refractedCosine(wo.z, eta), muI = refractedCosine(wi.z, eta);
    if (!(muO > 0 && muI > 0)) return Rgb(0);  // eta < 1: all is reflected
    const Vec3 up(0, 0, 1);
    const Vec3 inward = refractedDirection(-wi, up, wi.z, muI, eta);
    const Vec3 outward = -refractedDirection(-wo, up, wo.z, muO, eta);
    const float boundary = (1.0f - fresnelReflectance(wo.z, eta)) *
                           (1.0f - fresnelReflectance(wi.z, eta)) / (eta * eta * (muO + muI));
    Rgb albedo(0);
    for (int c = 0; c < 3; ++c)
        if (medium.sigmaT[c] > 0) albedo[c] = medium.sigmaS[c] / medium.sigmaT[c];
    return albedo * phaseBetween(medium, inward, outward) * boundary;
}

}  // namespace sss
