#pragma once
#include "sss/medium/half_space.h"
#include "sss/medium/profile.h"

#include <optional>
#include <string_view>

namespace sss {

// The energy convention, in one place.
//
// E is the TRANSMITTED irradiance, M = sum(R_d E A) the radiant exitance, and it leaves as
// L_o = M F_t(w_o) / (pi T), so that exactly M leaves. Single scattering is computed direction by
// direction with the rigorous half-space factor. Both together must return what radiative transfer
// returns; no profile does that by itself. Shares of the transmitted flux under diffuse light:
//
//   |            | transfer | single | dipole | better dipole | beam (multiple) |
//   |------------|----------|--------|--------|---------------|-----------------|
//   | Marble G   |  0.8050  | 0.0571 | 0.7911 |    0.7943     |     0.7655      |
//   | Skimmilk G |  0.8318  | 0.0831 | 0.8131 |    0.8183     |     0.7807      |
//
// The classic dipole's alpha' holds the first event: with single scattering added it is 5.5 % too
// bright. The better dipole's alpha'^2 claims to leave it out, but the flux that alpha' - alpha'^2
// takes away is 0.2 % where single scattering is 6 to 8 %: 6 % too bright. The beam's kappa takes
// out about half. So the convention does not ask what a profile claims: the shape of R_d is kept,
// and its total is set to what is left for two and more scatterings.
//
// A material whose single scattering is switched off has nothing to share: its diffusion is not
// scaled. It stands for all of the light then, and returns what its paper says, or the color that
// its medium was made from; scaled, a dark color would go black, since most of it is scattered
// once. (For one layer without the other there are the picture's layers.)

enum class EnergyConvention {
    Consistent,  ///< diffusion + single scattering = the radiative-transfer total
    Jensen,      ///< added as the papers do
};

/// "consistent" or "jensen". Throws Error{BadInput} for another name.
EnergyConvention energyConvention(std::string_view name);

/// Factor for the diffusion sum. Consistent: (transfer - single)/total of the profile in the
/// half-space, both for diffuse light: 0.85 to 0.98 for isotropic scattering and alpha' > 0.95;
/// above 1 where the profile is darker than the truth (forward scattering, low albedo). Jensen: 1.
/// `shownTotal` replaces the transfer's total: the color of a medium that was made from a color, so
/// that this color is what shows. 0 for a profile whose total is 0. A slab's profile takes the
/// factor of the half-space made of the same medium.
double multipleScatterScale(const Profile& profile, const ChannelMedium& medium,
                            EnergyConvention convention = EnergyConvention::Consistent,
                            std::optional<double> shownTotal = {});

}  // namespace sss
