#include "sss/optics/fresnel_moments.h"

#include "sss/optics/gauss_legendre.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

/// Moments for a boundary of index ratio n > 1, for light on its thin and on its dense side.
struct BothSides {
    double thinTwoC1, thinThreeC2, denseThreeC2;
};

// On the thin side, with c the cosine and q = sqrt(c^2 + n^2 - 1), put tanh x = (q - c)/(q + c).
// Then r_s = -tanh x, r_p = tanh(ln n - x), x runs from ln(n)/2 (normal) to infinity (grazing), and
//   c = a (1 - w)/sqrt(w), q = a (1 + w)/sqrt(w), w = tanh x, a = sqrt(n^2 - 1)/2:
// every integrand is positive and analytic, with its nearest pole at x = 0. Panels that double from
// x0 and stop at length 1 therefore converge geometrically with 16 points each. The dense side has
// the same reflectance at the refracted cosine q/n, and 1 below the critical angle.
BothSides integrate(double n, double logN, double contrast) {
    const double x0 = 0.5 * logN;
    const double a = 0.5 * std::sqrt(contrast);
    BothSides sums{0, 0, 0};
    const double end = x0 + 11;  // the weight falls like e^{-4x}
    for (double lo = x0; lo < end;) {
        const double hi = std::min({2 * lo, lo + 1, end});
        for (const GaussPoint& point : kGauss16) {
            const double x = lo + (hi - lo) * point.node;
            const double w = std::tanh(x);
            const double sech = 1 / std::cosh(x);
            const double rp = std::tanh(2 * x0 - x);
            const double reflectance = 0.5 * (w * w + rp * rp);
            const double rootW = std::sqrt(w);
            const double oneMinusW = std::exp(-x) * sech;
            const double c = a * oneMinusW / rootW;
            const double q = a * (1 + w) / rootW;
            // |dc| = a (1 + w) / (2 w^1.5) dw, dw = sech^2 dx
            const double dc = (hi - lo) * point.weight * 0.5 * q / w * sech * sech;
            sums.thinTwoC1 += 2 * c * reflectance * dc;
            sums.thinThreeC2 += 3 * c * c * reflectance * dc;
            sums.denseThreeC2 += 3 * q * c * reflectance * dc;
        }
        lo = hi;
    }
    const double sinCritical = std::sqrt(contrast) / n;
    sums.denseThreeC2 = sinCritical * sinCritical * sinCritical + sums.denseThreeC2 / (n * n * n);
    return sums;
}

}  // namespace

FresnelMoments exactFresnelMoments(double eta) {
    if (eta == 1) return {};
    const double etaSquared = eta * eta;
    const double contrast = (eta - 1) * (eta + 1);
    if (eta < 1) {
        const BothSides sides = integrate(1 / eta, -std::log(eta), -contrast / etaSquared);
        return {sides.thinTwoC1, sides.thinThreeC2, 1 - sides.thinTwoC1};
    }
    const BothSides sides = integrate(eta, std::log(eta), contrast);
    return {(contrast + sides.thinTwoC1) / etaSquared, sides.denseThreeC2,
            (1 - sides.thinTwoC1) / etaSquared};
}

FresnelMoments polynomialFresnelMoments(double eta) {
    const double e2 = eta * eta;
    const double e3 = e2 * eta;
    const double e4 = e2 * e2;
    const double e5 = e4 * eta;
    FresnelMoments fit;
    if (eta < 1) {
        fit.twoC1 =
            0.919317 - 3.4793 * eta + 6.75335 * e2 - 7.80989 * e3 + 4.98554 * e4 - 1.36881 * e5;
        fit.threeC2 =
            0.828421 - 2.62051 * eta + 3.36231 * e2 - 1.95284 * e3 + 0.236494 * e4 + 0.145787 * e5;
    } else {
        fit.twoC1 =
            -9.23372 + 22.2272 * eta - 20.9292 * e2 + 10.2291 * e3 - 2.54396 * e4 + 0.254913 * e5;
        fit.threeC2 = -1641.1 + 135.926 / e3 - 656.175 / e2 + 1376.53 / eta + 1213.67 * eta -
                      568.556 * e2 + 164.798 * e3 - 27.0181 * e4 + 1.91826 * e5;
    }
    fit.transmittanceOut = 1 - fit.twoC1;
    return fit;
}

FresnelMoments roundedPolynomialFresnelMoments(double eta) {
    const double e2 = eta * eta;
    const double e3 = e2 * eta;
    const double e4 = e2 * e2;
    const double e5 = e4 * eta;
    FresnelMoments fit;
    if (eta < 1) {
        fit.twoC1 = 2 * (0.45966 - 1.73965 * eta + 3.37668 * e2 - 3.904945 * e3 + 2.49277 * e4 -
                         0.68441 * e5);
        fit.threeC2 = 3 * (0.27614 - 0.87350 * eta + 1.12077 * e2 - 0.65095 * e3 + 0.07883 * e4 +
                           0.04860 * e5);
    } else {
        fit.twoC1 = 2 * (-4.61686 + 11.1136 * eta - 10.4646 * e2 + 5.11455 * e3 - 1.27198 * e4 +
                         0.12746 * e5);
        fit.threeC2 = 3 * (-547.033 + 45.3087 / e3 - 218.725 / e2 + 458.843 / eta + 404.557 * eta -
                           189.519 * e2 + 54.9327 * e3 - 9.00603 * e4 + 0.63942 * e5);
    }
    fit.transmittanceOut = 1 - fit.twoC1;
    return fit;
}

double polynomialDiffuseReflectance(double eta) {
    const double inverse = 1 / eta;
    if (eta < 1) {
        return -0.4399 + inverse * (0.7099 + inverse * (-0.3319 + inverse * 0.0636));
    }
    return inverse * (-1.440 * inverse + 0.710) + 0.668 + 0.0636 * eta;
}

double hemisphericalTransmittance(double eta) {
    return eta * eta * exactFresnelMoments(eta).transmittanceOut;
}

}  // namespace sss
