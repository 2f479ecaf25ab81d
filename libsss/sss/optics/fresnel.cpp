#include "sss/optics/fresnel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sss {
namespace {

// With c the incident cosine and q = eta * (refracted cosine) = sqrt(c^2 + eta^2 - 1), Fresnel's
// amplitudes are r_s = (c - q)/(c + q) and r_p = (eta^2 c - q)/(eta^2 c + q). Expanding each
// numerator by its conjugate takes out contrast = eta^2 - 1, which is where they cancel.
template <typename T>
T contrastOf(T eta) {
    return (eta - 1) * (eta + 1);
}

/// The contrast of 1/eta, from eta itself: 1/eta - 1 would lose what 1/eta rounds away.
template <typename T>
T contrastOfInverse(T eta) {
    return (1 - eta) * (1 + eta) / (eta * eta);
}

template <typename T>
T dielectric(T cosine, T eta, T contrast) {
    if (contrast == 0) return 0;
    const T c = std::min(std::abs(cosine), T(1));
    const T qSquared = c * c + contrast;
    if (qSquared <= 0) return 1;
    const T q = std::sqrt(qSquared);
    const T etaSquaredC = eta * eta * c;
    const T sumS = c + q;
    const T sumP = etaSquaredC + q;
    const T rs = contrast / sumS / sumS;
    const T rp = contrast / sumP * (((eta * eta + 1) * c * c - 1) / sumP);
    return std::min(T(0.5) * (rs * rs + rp * rp), T(1));
}

template <typename T>
T refracted(T cosine, T eta, T contrast) {
    const T c = std::min(std::abs(cosine), T(1));
    const T qSquared = c * c + contrast;
    return qSquared > 0 ? std::min(std::sqrt(qSquared) / eta, T(1)) : T(0);
}

// |r_s|^2 and |r_p|^2 with q = a + i b = sqrt((eta + i k)^2 - sin^2) [Born & Wolf section 14.2].
template <typename T>
T conductor(T cosine, T eta, T k) {
    if (k == 0) return dielectric(cosine, eta, contrastOf(eta));
    const T c = std::min(std::abs(cosine), T(1));
    const T cc = c * c;
    const T ss = 1 - cc;
    const T realPart = (eta - k) * (eta + k) - ss;
    const T modulus = std::hypot(realPart, 2 * eta * k);  // a^2 + b^2
    const T a = std::sqrt(std::max((modulus + realPart) / 2, T(0)));
    const T rs = (modulus - 2 * a * c + cc) / (modulus + 2 * a * c + cc);
    if (c < std::numeric_limits<T>::min()) return 1;  // where 1/c would overflow
    const T tt = ss / c * ss;  // sin^2 tan^2, times the cosine to stay finite at grazing
    const T middle = 2 * a * ss;
    const T ratio = (modulus * c + tt - middle) / (modulus * c + tt + middle);
    return std::clamp(T(0.5) * rs * (1 + ratio), T(0), T(1));
}

}  // namespace

double fresnelReflectance(double cosOutside, double eta) {
    return dielectric(cosOutside, eta, contrastOf(eta));
}
float fresnelReflectance(float cosOutside, float eta) {
    return dielectric(cosOutside, eta, contrastOf(eta));
}

double fresnelReflectanceFromInside(double cosInside, double eta) {
    return dielectric(cosInside, 1 / eta, contrastOfInverse(eta));
}
float fresnelReflectanceFromInside(float cosInside, float eta) {
    return dielectric(cosInside, 1 / eta, contrastOfInverse(eta));
}

double refractedCosine(double cosOutside, double eta) {
    return refracted(cosOutside, eta, contrastOf(eta));
}
float refractedCosine(float cosOutside, float eta) {
    return refracted(cosOutside, eta, contrastOf(eta));
}

double refractedCosineFromInside(double cosInside, double eta) {
    return refracted(cosInside, 1 / eta, contrastOfInverse(eta));
}
float refractedCosineFromInside(float cosInside, float eta) {
    return refracted(cosInside, 1 / eta, contrastOfInverse(eta));
}

double conductorReflectance(double cosOutside, double eta, double k) {
    return conductor(cosOutside, eta, k);
}
float conductorReflectance(float cosOutside, float eta, float k) {
    return conductor(cosOutside, eta, k);
}

}  // namespace sss
