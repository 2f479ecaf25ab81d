#pragma once
#include <algorithm>
#include <cmath>

namespace sss {

// The two kernels of all image-source models, for a point source at height z above or below the
// surface, at distance r along it, d = sqrt(r^2 + z^2). Both without 1/(4 pi).

/// A radius in mean free paths, at most 1e120 of them: no power that a profile takes of it
/// overflows, and R_d has been below the smallest double for long.
inline double reducedRadius(double rMm, double sigmaTPrime) {
    return std::min(rMm * sigmaTPrime, 1e120);
}

/// Distance from height z to a point at r on the surface; lengths below 1e150, as reducedRadius
/// makes them. Below 1e-150 the squares vanish, which matters only where both are that small.
inline double slant(double r, double z) { return std::sqrt(r * r + z * z); }

/// Flux kernel z (1 + sigma d) e^{-sigma d} / d^3: odd in z, free of cancellation; 0 for a source
/// in the surface itself.
inline double fluxKernel(double z, double sigmaTr, double r) {
    if (z == 0) return 0;
    const double d = slant(r, z);
    const double inverse = 1 / d;
    return z * inverse * inverse * inverse * (1 + sigmaTr * d) * std::exp(-sigmaTr * d);
}

/// Tail of the flux kernel: integral of r dr from `a` to infinity, z e^{-sigma d} / d.
inline double fluxKernelTail(double z, double sigmaTr, double a) {
    const double d = slant(a, z);
    return z / d * std::exp(-sigmaTr * d);
}

/// dv - dr for heights zv, zr (signed): the difference of distances without cancellation.
inline double distanceGap(double zr, double zv, double r) {
    return (zv - zr) * (zv + zr) / (slant(r, zr) + slant(r, zv));
}

/// (1 - e^{-sigma x}) / sigma; x at sigma = 0.
inline double absorbedLength(double sigma, double x) {
    return sigma == 0 ? x : -std::expm1(-sigma * x) / sigma;
}

/// Both kernels of a source at depth zr with its mirror image at height zv > zr >= 0 above the
/// surface: fluxKernel(zr) + fluxKernel(zv), and the fluence kernel e^{-sigma dr}/dr - e^{-sigma
/// dv}/dv, rearranged so that it does not cancel as sigma -> 0 or r -> infinity. Two exponentials
/// in all.
struct ImagePair {
    double flux, fluence;

    ImagePair(double zr, double zv, double sigmaTr, double r) {
        const double dr = slant(r, zr);
        const double dv = slant(r, zv);
        const double gap = (zv - zr) * (zv + zr) / (dr + dv);
        const double atReal = std::exp(-sigmaTr * dr) / dr;
        const double lost = -std::expm1(-sigmaTr * gap);
        const double atMirror = atReal * dr * (1 - lost) / dv;
        flux = zr * (1 + sigmaTr * dr) * atReal / (dr * dr) +
               zv * (1 + sigmaTr * dv) * atMirror / (dv * dv);
        fluence = atReal * (gap + dr * lost) / dv;
    }
};

/// Tail of the fluence kernel: integral of r dr from `a` to infinity.
inline double fluenceKernelTail(double zr, double zv, double sigmaTr, double a) {
    return std::exp(-sigmaTr * slant(a, zr)) * absorbedLength(sigmaTr, distanceGap(zr, zv, a));
}

}  // namespace sss
