#include "sss/optics/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace sss;

namespace {

/// The textbook formulas in long double.
long double textbook(long double c, long double eta) {
    const long double sine2 = (1 - c * c) / (eta * eta);
    if (sine2 >= 1) return 1;
    const long double t = std::sqrt(1 - sine2);
    const long double rs = (c - eta * t) / (c + eta * t);
    const long double rp = (eta * c - t) / (eta * c + t);
    return (rs * rs + rp * rp) / 2;
}

TEST(Fresnel, AgreesWithTheTextbookFormulas) {
    for (const double eta : {0.2, 0.75, 0.99, 1.01, 1.3, 1.5, 2.4, 5.0}) {
        for (int i = 0; i <= 64; ++i) {
            const double c = i / 64.0;
            const auto expected = static_cast<double>(textbook(c, eta));
            EXPECT_NEAR(fresnelReflectance(c, eta), expected, 2e-13 * expected + 1e-17)
                << "eta " << eta << " cosine " << c;
            EXPECT_NEAR(fresnelReflectance(static_cast<float>(c), static_cast<float>(eta)),
                        static_cast<double>(textbook(c, static_cast<float>(eta))), 3e-5);
        }
    }
}

TEST(Fresnel, NormalIncidenceGrazingAndTotalReflection) {
    EXPECT_NEAR(fresnelReflectance(1.0, 1.5), 0.04, 1e-16);
    EXPECT_NEAR(fresnelReflectance(1.0, 1 / 1.5), 0.04, 1e-16);
    EXPECT_EQ(fresnelReflectance(0.0, 1.5), 1.0);
    EXPECT_EQ(fresnelReflectance(0.0, 1 + 1e-15), 1.0);
    EXPECT_EQ(fresnelReflectance(0.5, 0.5), 1.0);
    EXPECT_EQ(fresnelReflectanceFromInside(0.5, 1.5), 1.0);
    EXPECT_EQ(fresnelReflectance(-0.3, 1.5), fresnelReflectance(0.3, 1.5));
    EXPECT_LE(fresnelReflectance(1.0 + 1e-12, 1.5), 1.0);
}

TEST(Fresnel, MatchedIndicesReflectNothingEvenAtGrazing) {
    for (const double c : {0.0, 1e-300, 0.5, 1.0}) EXPECT_EQ(fresnelReflectance(c, 1.0), 0.0);
    EXPECT_EQ(fresnelReflectance(0.0f, 1.0f), 0.0f);
    EXPECT_EQ(conductorReflectance(0.0, 1.0, 0.0), 0.0);
    EXPECT_EQ(refractedCosine(0.3, 1.0), 0.3);
}

TEST(Fresnel, NearlyMatchedIndicesDoNotCancel) {
    // R(normal) = ((eta - 1)/(eta + 1))^2, with eta - 1 exactly representable.
    const double contrast = 0x1p-40;
    const double expected = contrast * contrast / ((2 + contrast) * (2 + contrast));
    EXPECT_NEAR(fresnelReflectance(1.0, 1 + contrast), expected, 1e-14 * expected);
    const double below = contrast * contrast / ((2 - contrast) * (2 - contrast));
    EXPECT_NEAR(fresnelReflectance(1.0, 1 - contrast), below, 1e-14 * below);
    EXPECT_NEAR(fresnelReflectanceFromInside(1.0, 1 + contrast), expected, 1e-14 * expected);
}

TEST(Fresnel, IsReversible) {
    for (const double eta : {0.5, 0.9, 1.1, 1.5, 3.0}) {
        for (int i = 1; i <= 20; ++i) {
            const double outside = i / 20.0;
            const double inside = refractedCosine(outside, eta);
            if (inside == 0) continue;
            EXPECT_NEAR(refractedCosineFromInside(inside, eta), outside, 1e-13);
            EXPECT_NEAR(fresnelReflectanceFromInside(inside, eta), fresnelReflectance(outside, eta),
                        1e-12);
            const double sineOut = std::sqrt(1 - outside * outside);
            const double sineIn = std::sqrt(1 - inside * inside);
            EXPECT_NEAR(sineOut, eta * sineIn, 1e-7);
        }
    }
}

TEST(Fresnel, ConductorAgreesWithTheComplexFormula) {
    // Gold at 650 nm: 0.15557 + 3.6024 i. Normal incidence: ((n-1)^2 + k^2)/((n+1)^2 + k^2).
    const double eta = 0.15557, k = 3.6024;
    const double normal = ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
    EXPECT_NEAR(conductorReflectance(1.0, eta, k), normal, 1e-14);
    EXPECT_EQ(conductorReflectance(0.0, eta, k), 1.0);
    EXPECT_EQ(conductorReflectance(0.7, 1.5, 0.0), fresnelReflectance(0.7, 1.5));
    EXPECT_NEAR(conductorReflectance(0.7, 1.5, 1e-8), fresnelReflectance(0.7, 1.5), 1e-12);
    EXPECT_NEAR(conductorReflectance(0.7f, 0.2f, 3.9f), conductorReflectance(0.7, 0.2, 3.9), 1e-5);
    double last = 1.0;
    for (int i = 1; i <= 1000; ++i) {
        const double r = conductorReflectance(i / 1000.0, eta, k);
        EXPECT_GT(r, 0.9);
        EXPECT_LE(r, 1.0);
        EXPECT_LT(std::abs(r - last), 0.01);
        last = r;
    }
}

}  // namespace
