#pragma once
#include "sss/medium/medium.h"
#include "sss/medium/profile.h"

namespace sss {

/// Share of the transmitted flux that leaves a half-space after exactly one scattering, straight
/// from there through the boundary (light reflected inside scatters again): the rigorous half-space
/// formula L = alpha p F_t F_t mu_i / (eta^2 (mu_i' + mu_o')), integrated. Relative error below
/// 1e-6 for every g up to |g| = 0.9999, some ms.
double singleScatterAlbedo(const ChannelMedium& medium, Illumination illumination);

}  // namespace sss
