#include "sss/optics/phase.h"

#include "sss/base/vec.h"
#include "sss/optics/gauss_legendre.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

using namespace sss;

namespace {

constexpr double kAsymmetries[] = {-0.99, -0.9, -0.5, -1e-4, 0.0, 1e-9, 0.3, 0.49, 0.51, 0.9, 0.99};

/// Integral of f(cos) over cos in [lo, hi], with panels that shrink towards both poles.
template <typename Function>
double overCosines(double lo, double hi, const Function& f) {
    double sum = 0;
    for (double width = 2; width > 1e-9; width *= 0.5) {
        // The rings 1 -+ cos in [width/2, width]; the outermost pair meets at the equator.
        const double far = std::min(width, 1.0), near = width * 0.5;
        if (far <= near) continue;
        for (const auto& [a, b] : {std::pair{-1 + near, -1 + far}, std::pair{1 - far, 1 - near}}) {
            const double from = std::clamp(a, lo, hi), to = std::clamp(b, lo, hi);
            if (to > from) sum += gauss16(from, to, f);
        }
    }
    return sum;
}

TEST(Phase, IntegratesToOneWithMeanCosineG) {
    for (const double g : kAsymmetries) {
        const double total = overCosines(-1, 1, [&](double c) { return henyeyGreenstein(c, g); });
        const double mean =
            overCosines(-1, 1, [&](double c) { return c * henyeyGreenstein(c, g); });
        // The polar caps that the quadrature leaves out hold up to 1e-5 of the sharpest peak.
        EXPECT_NEAR(2 * kPi * total, 1.0, 1e-5) << g;
        EXPECT_NEAR(2 * kPi * mean, g, 1e-5) << g;
        EXPECT_NEAR(2 * kPi * total, 1.0, std::abs(g) < 0.95 ? 1e-7 : 1e-5) << g;
    }
}

TEST(Phase, IsTheFormulaAndIsotropicAtZero) {
    EXPECT_DOUBLE_EQ(henyeyGreenstein(0.37, 0.0), 1 / (4 * kPi));
    const double g = 0.7, c = -0.2;
    EXPECT_NEAR(henyeyGreenstein(c, g),
                (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * c, 1.5)), 1e-15);
    EXPECT_NEAR(henyeyGreenstein(-0.2f, 0.7f), henyeyGreenstein(c, g), 1e-7);
}

TEST(Phase, SamplesInvertTheDistribution) {
    for (const double g : kAsymmetries) {
        double last = -1;
        for (int i = 0; i <= 32; ++i) {
            const double u = i / 32.0;
            const double c = sampleHenyeyGreenstein(u, g);
            EXPECT_GE(c, last);
            last = c;
            const double below =
                overCosines(-1, c, [&](double x) { return henyeyGreenstein(x, g); });
            EXPECT_NEAR(2 * kPi * below, u, 1e-5) << "g " << g;
        }
        EXPECT_NEAR(sampleHenyeyGreenstein(0.0, g), -1, 1e-12);
        EXPECT_NEAR(sampleHenyeyGreenstein(1.0, g), 1, 1e-12);
    }
}

TEST(Phase, SamplingIsContinuousInG) {
    for (const double u : {0.01, 0.3, 0.5, 0.99}) {
        EXPECT_NEAR(sampleHenyeyGreenstein(u, 1e-12), 2 * u - 1, 1e-11);
        EXPECT_NEAR(sampleHenyeyGreenstein(u, 0.5), sampleHenyeyGreenstein(u, 0.5 - 1e-12), 1e-10);
        EXPECT_NEAR(sampleHenyeyGreenstein(static_cast<float>(u), 0.4f),
                    sampleHenyeyGreenstein(u, 0.4), 1e-6);
    }
}

}  // namespace
