#include "sss/optics/fresnel_moments.h"

#include "sss/optics/fresnel.h"
#include "sss/optics/gauss_legendre.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace sss;

namespace {

/// Integral of power mu^(power-1) R over [0, 1] by brute force: panels that shrink towards the
/// critical angle from both sides.
double bruteMoment(double eta, int power) {
    const double critical = eta > 1 ? std::sqrt((eta - 1) * (eta + 1)) / eta : 0.0;
    double sum = std::pow(critical, power);
    const auto integrand = [&](double mu) {
        return power * std::pow(mu, power - 1) * fresnelReflectanceFromInside(mu, eta);
    };
    double hi = 1;
    for (int i = 0; i < 60; ++i) {
        const double lo = critical + (hi - critical) * 0.5;
        sum += gauss16(lo, hi, integrand);
        hi = lo;
    }
    return sum;
}

TEST(FresnelMoments, AgreeWithBruteForce) {
    for (const double eta : {0.2, 0.5, 0.75, 0.95, 1.05, 1.3, 1.5, 2.4, 3.0, 5.0}) {
        const FresnelMoments moments = exactFresnelMoments(eta);
        const double two = bruteMoment(eta, 2), three = bruteMoment(eta, 3);
        EXPECT_NEAR(moments.twoC1, two, 2e-13 * two) << eta;
        EXPECT_NEAR(moments.threeC2, three, 2e-13 * three) << eta;
        EXPECT_NEAR(moments.transmittanceOut, 1 - two, 1e-13) << eta;
    }
}

TEST(FresnelMoments, AgreeWithTheClosedForm) {
    // Walsh's formula for the reflectance of diffuse light from outside, n > 1.
    for (const double n : {1.3, 1.33, 1.5, 2.0, 3.0, 4.0, 5.0}) {
        const double n2 = n * n, n4 = n2 * n2;
        const double closed = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
                              n2 * (n2 - 1) * (n2 - 1) / ((n2 + 1) * (n2 + 1) * (n2 + 1)) *
                                  std::log((n - 1) / (n + 1)) -
                              2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
                              8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
        EXPECT_NEAR(hemisphericalTransmittance(n), 1 - closed, 2e-14);
        EXPECT_NEAR(exactFresnelMoments(n).transmittanceOut, (1 - closed) / n2, 1e-14);
        EXPECT_NEAR(exactFresnelMoments(1 / n).twoC1, closed, 1e-14);
    }
}

TEST(FresnelMoments, TableOfTheGeometryCases) {
    EXPECT_NEAR(hemisphericalTransmittance(1.3), 0.93886817484203, 1e-14);
    EXPECT_NEAR(hemisphericalTransmittance(1.5), 0.90822204065765, 1e-14);
    EXPECT_NEAR(exactFresnelMoments(1.33).threeC2, 0.328238523607, 1e-12);
    EXPECT_NEAR(exactFresnelMoments(1.4).threeC2, 0.388782824275, 1e-12);
    const FresnelMoments m = exactFresnelMoments(1.5);
    EXPECT_NEAR((1 + m.threeC2) / m.transmittanceOut, 3.62793295822, 1e-10);
    EXPECT_NEAR((1 + m.twoC1) / m.transmittanceOut, 3.9547355146122, 1e-12);
}

TEST(FresnelMoments, ContinuousThroughMatchedIndices) {
    const FresnelMoments one = exactFresnelMoments(1.0);
    EXPECT_EQ(one.twoC1, 0.0);
    EXPECT_EQ(one.threeC2, 0.0);
    EXPECT_EQ(one.transmittanceOut, 1.0);
    for (const double step : {1e-15, 1e-12, 1e-8, 1e-5}) {
        for (const double eta : {1 - step, 1 + step}) {
            const FresnelMoments m = exactFresnelMoments(eta);
            EXPECT_GE(m.twoC1, 0.0);
            EXPECT_GE(m.threeC2, 0.0);
            EXPECT_LT(m.twoC1, 5 * step);
            EXPECT_LT(m.threeC2, 5 * step + 4 * std::pow(step, 1.5));
        }
    }
}

TEST(FresnelMoments, PolynomialsAreNearWhereTheyHold) {
    for (const double eta : {0.75, 1.2, 1.3, 1.4, 1.5, 2.0}) {
        const FresnelMoments exact = exactFresnelMoments(eta), fit = polynomialFresnelMoments(eta);
        EXPECT_NEAR(fit.twoC1, exact.twoC1, 2e-3) << eta;
        EXPECT_NEAR(fit.threeC2, exact.threeC2, 5e-3) << eta;
        EXPECT_NEAR(polynomialDiffuseReflectance(eta), exact.twoC1, 1.7e-3) << eta;
        const FresnelMoments rounded = roundedPolynomialFresnelMoments(eta);
        EXPECT_NEAR(rounded.twoC1, fit.twoC1, 1e-3) << eta;
        EXPECT_NEAR(rounded.threeC2, fit.threeC2, 1e-2) << eta;
    }
    EXPECT_NEAR(1 - polynomialDiffuseReflectance(1.3), 0.555237159763, 1e-12);
    EXPECT_NEAR(polynomialFresnelMoments(1.3).transmittanceOut, 0.55470533091, 1e-11);
    EXPECT_NEAR(polynomialFresnelMoments(1.3).threeC2, 0.297447844736, 1e-11);
}

}  // namespace
