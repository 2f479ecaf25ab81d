#pragma once
#include "sss/medium/medium.h"
#include "sss/medium/profile.h"

namespace sss {

/// Share of the transmitted flux that leaves a half-space again, by radiative transfer, for light
/// along the normal and for diffuse light from outside.
struct HalfSpaceTotals {
    double normal = 0;
    double diffuse = 0;
};

/// Totals of a half-space with a smooth boundary, Henyey-Greenstein scattering, any albedo and eta:
/// adding-doubling [van de Hulst 1980; Prahl 1995] of the azimuthal mean on 32 directions, the
/// forward peak by delta-M [Wiscombe 1977]. Within 1e-4 of exact for |g| <= 0.9, 1e-3 beyond;
/// exactly 1 without absorption, 0 without scattering. About 20 ms.
HalfSpaceTotals halfSpaceTotals(const ChannelMedium& medium);

/// Share of the transmitted flux that leaves after exactly one scattering, straight from there
/// through the boundary (light reflected inside scatters again): the rigorous half-space formula
/// L = alpha p F_t F_t mu_i / (eta^2 (mu_i' + mu_o')), integrated. Relative error below 1e-6.
double singleScatterAlbedo(const ChannelMedium& medium, Illumination illumination);

}  // namespace sss
