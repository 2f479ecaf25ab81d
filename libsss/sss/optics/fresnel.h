#pragma once

namespace sss {

// Smooth dielectric and conductor boundaries, unpolarised light. Everywhere
// eta = (index inside) / (index outside), > 0; cosines are those of the angle to the normal on the
// side named, in [0, 1]; the sign of a cosine is ignored.

/// Reflectance of a dielectric for light that arrives from OUTSIDE. 1 at total internal reflection
/// (eta < 1), 1 at grazing incidence, exactly 0 for eta = 1. Free of cancellation: relative error
/// a few ulp down to eta - 1 = 1e-15.
double fresnelReflectance(double cosOutside, double eta);
float fresnelReflectance(float cosOutside, float eta);

/// The same for light that arrives from INSIDE.
double fresnelReflectanceFromInside(double cosInside, double eta);
float fresnelReflectanceFromInside(float cosInside, float eta);

/// Cosine on the inner side for light arriving from outside (Snell); 0 where all is reflected.
double refractedCosine(double cosOutside, double eta);
float refractedCosine(float cosOutside, float eta);

/// Cosine on the outer side for light arriving from inside; 0 where all is reflected.
double refractedCosineFromInside(double cosInside, double eta);
float refractedCosineFromInside(float cosInside, float eta);

/// Reflectance of a conductor of complex index eta + i k (both relative to the outside), for one
/// channel. k = 0 is the dielectric.
double conductorReflectance(double cosOutside, double eta, double k);
float conductorReflectance(float cosOutside, float eta, float k);

}  // namespace sss
