#pragma once
#include "sss/integrate/body_optics.h"

namespace sss {

/// How far apart points may lie so that the sum over them differs from the integral by a share of
/// the tolerance.
///
/// Measured on planes and spheres (tests/unit/cloud/quadrature_test.cpp) with our cells and
/// centroids: relative RMS error = 0.125 w^1.5 (h / l)^3.2, with l the transport mean free path and
/// w = l sqrt(integral R_d^2 dA) / R_tot, a profile's concentration (0.135 marble, 0.41 ketchup).
struct SpacingRule {
    double spacingMm = 0;         ///< smallest over the channels
    double expectedRmsError = 0;  ///< of the sum, in the channel that decides
    int channel = 0;              ///< that decides
};
SpacingRule spacingFor(const BodyOptics& optics, double tolerance);

/// w of one profile, by quadrature.
double profileConcentration(const Profile& profile, double meanFreePathMm);

/// The same rule read the other way: RMS error to expect at a spacing, worst channel.
double expectedQuadratureError(const BodyOptics& optics, double spacingMm);

}  // namespace sss
