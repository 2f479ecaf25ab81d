#pragma once
#include "sss/integrate/medium_coefficients.h"

namespace sss {

/// BRDF (sr^-1) of a half-space with a smooth boundary for light that has been scattered exactly
/// once inside, f^(1) = alpha p F_t F_t / (eta^2 (mu_i' + mu_o')) with the cosines inside, by
/// channel [JMLH01 section 2.4, with the 1 / eta^2 of radiance that it leaves out]. Directions away
/// from the surface, z = its normal; `eta` = inside / outside. Its integral over both hemispheres
/// is singleScatterAlbedo() (medium/single_scatter.h) times the transmitted flux.
Rgb halfSpaceSingleScattering(const MediumCoefficients& medium, float eta, const Vec3& wo,
                              const Vec3& wi);

}  // namespace sss
