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

}  // namespace sss
