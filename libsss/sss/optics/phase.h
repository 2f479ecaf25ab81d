#pragma once

namespace sss {

/// Henyey-Greenstein phase function per steradian, normalised to 1 over the sphere. `cosTheta` is
/// between the PROPAGATION directions before and after; |g| < 1, g > 0 is forward.
double henyeyGreenstein(double cosTheta, double g);
float henyeyGreenstein(float cosTheta, float g);

/// The same by the distance to the peak, 1 - cos theta for g > 0 and 1 + cos theta for g < 0, which
/// a caller may know without cancellation.
double henyeyGreensteinOffPeak(double distance, double g);

/// cos theta in [-1, 1] distributed as the phase function, from u in [0, 1); increasing in u.
/// Continuous through g = 0, where it is 2u - 1.
double sampleHenyeyGreenstein(double u, double g);
float sampleHenyeyGreenstein(float u, float g);

}  // namespace sss
