#pragma once

namespace sss {

/// Henyey-Greenstein phase function per steradian, normalised to 1 over the sphere. `cosTheta` is
/// between the PROPAGATION directions before and after; |g| < 1, g > 0 is forward.
double henyeyGreenstein(double cosTheta, double g);
float henyeyGreenstein(float cosTheta, float g);

/// cos theta in [-1, 1] distributed as the phase function, from u in [0, 1); increasing in u.
/// Continuous through g = 0, where it is 2u - 1.
double sampleHenyeyGreenstein(double u, double g);
float sampleHenyeyGreenstein(float u, float g);

}  // namespace sss
