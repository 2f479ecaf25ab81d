#pragma once
#include "sss/medium/medium.h"
#include "sss/optics/fresnel_moments.h"

#include <cmath>

namespace sss {

/// Quantities shared by the better dipole and photon beam diffusion, in transport mean free paths
/// [d'Eon & Irving 2011; d'Eon 2012].
struct GrosjeanMedium {
    double diffusion;      ///< D, Grosjean's (2 sigma_a + sigma'_s) / (3 sigma'_t^2)
    double sigmaTr;        ///< sqrt(sigma_a / D)
    double fluenceWeight;  ///< C_phi / D
    double fluxWeight;     ///< C_E
    double extrapolation;  ///< 4 A D: z_v = z_r + this

    GrosjeanMedium(const ChannelMedium& medium, const FresnelMoments& moments) {
        const double absorption = medium.reducedAbsorption();
        diffusion = (1 + absorption) / 3;
        sigmaTr = std::sqrt(absorption / diffusion);
        fluenceWeight = 0.25 * moments.transmittanceOut / diffusion;
        fluxWeight = 0.5 * (1 - moments.threeC2);
        extrapolation = 4 * diffusion * (1 + moments.threeC2) / moments.transmittanceOut;
    }
};

}  // namespace sss
