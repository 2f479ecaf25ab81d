#pragma once

namespace sss {

/// Hemispherical averages of the boundary's Fresnel reflectance R(mu), eta = inside / outside:
/// 2 C1 = 2 int R mu dmu and 3 C2 = 3 int R mu^2 dmu over [0, 1], for light INSIDE going out.
struct FresnelMoments {
    double twoC1 = 0;             ///< F_dr, the internal diffuse reflectance, in [0, 1)
    double threeC2 = 0;           ///< in [0, 1)
    double transmittanceOut = 1;  ///< 1 - 2 C1, formed without cancellation
};

/// Exact moments: relative error below 1e-14 for eta in [0.2, 5], continuous through eta = 1, where
/// they are 0. About 20 us: store the result.
FresnelMoments exactFresnelMoments(double eta);

/// The fits of [d'Eon & Irving 2011] used by the better dipole and by photon beam diffusion. Right
/// to 0.01 for eta in [0.5, 2.4]; they jump at eta = 1 and are meaningless beyond 2.6.
FresnelMoments polynomialFresnelMoments(double eta);

/// The same fits as pbrt carries them for photon beam diffusion: C1 and C2 to six digits, doubled
/// and tripled here. They differ from the above by about 1e-4.
FresnelMoments roundedPolynomialFresnelMoments(double eta);

/// F_dr of [JMLH01] (eta >= 1) and of [Egan & Hilgeman 1973] (eta < 1), as fits. 0.0016 at eta = 1.
double polynomialDiffuseReflectance(double eta);

/// Share of a diffuse (Lambertian) illumination from outside that enters: 1 - 2 int F mu dmu.
/// 0.9082 at eta = 1.5. Equals eta^2 times the share of diffuse light inside that leaves.
double hemisphericalTransmittance(double eta);

}  // namespace sss
