#pragma once
#include "sss/medium/medium.h"
#include "sss/optics/fresnel_moments.h"

namespace sss {

/// What the diffusion equation needs to know of a medium, per channel [JMLH01 section 2.1; d'Eon &
/// Irving 2011 for D and the moments]:
///   D lap(phi) = sigma_a phi - Q inside, phi + b dphi/dn = 0 on the boundary (n outward).
struct DiffusionConstants {
    DRgb diffusionMm{0};    ///< D, Grosjean's
    DRgb screening{0};      ///< k = sqrt(sigma_a / D), mm^-1; 0 without absorption
    DRgb boundaryMm{0};     ///< b = 2 A D
    DRgb impedance{0};      ///< 2 A: fluence over radiant exitance at the boundary
    DRgb reducedAlbedo{0};  ///< alpha', the share of a first collision that scatters
    DRgb extinction{0};     ///< sigma'_t, mm^-1
    /// What is seen along a line of sight comes from s deep by exp(-fading s), mm^-1: sigma'_t, and
    /// k^2 / sigma'_t, the rate at which even fluence begins to fall off within a mean free path.
    DRgb fading{0};
    /// Channels that scatter; the others send nothing back, and their numbers above mean nothing.
    bool scatters[3] = {false, false, false};
};

DiffusionConstants diffusionConstants(const Medium& medium, const FresnelMoments& moments);

/// Share of diffuse light from outside, once inside, that a flat half-space sends out again by this
/// equation. A first collision at depth s brings exp(-k s) / (1 + b k) of itself out.
double diffuseHalfSpaceShare(const DiffusionConstants& medium, int channel, double eta);
/// What the exitance by this equation is to be multiplied with, by channel, so that such a
/// half-space sends out what radiative transfer says (medium/half_space.h): 1 without absorption,
/// 0.995 for marble, 0.87 at a reduced albedo of 0.68. What slabs let through is too bright by as
/// much, within 3 % from an albedo of 0.6 on.
DRgb transferScale(const DiffusionConstants& constants, const Medium& medium);

}  // namespace sss
