#include "sss/image/filter.h"

#include "sss/base/sampler.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sss {
namespace {

/// Second moment of a filter of radius 1 by the midpoint rule.
double secondMoment(const FilterInfo& info) {
    double mass = 0, moment = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double t = (2.0 * i + 1.0) / n - 1.0;
        mass += info.shape(t);
        moment += info.shape(t) * t * t;
    }
    return moment / mass;
}

TEST(Filter, SampledMomentsAreTheFilters) {
    for (std::size_t kind = 0; kind < kFilterCount; ++kind) {
        const FilterInfo& info = kPixelFilters[kind];
        for (const double radius : {0.0, 2.5}) {
            const PixelFilter filter(static_cast<FilterKind>(kind), radius);
            const double expected = radius > 0 ? radius : info.defaultRadiusPixels;
            EXPECT_EQ(filter.radiusPixels(), expected);
            DVec2 sum{0}, squares{0};
            double product = 0;
            const std::uint32_t n = 1 << 14;
            for (std::uint32_t i = 0; i < n; ++i) {
                const DVec2 offset(filter.sample(Sampler(7, i).next2D()));
                ASSERT_LE(std::abs(offset.x), expected);
                ASSERT_LE(std::abs(offset.y), expected);
                sum += offset;
                squares += offset * offset;
                product += offset.x * offset.y;
            }
            const double variance = secondMoment(info) * expected * expected;
            for (int axis = 0; axis < 2; ++axis) {
                EXPECT_NEAR(sum[axis] / n, 0, 2e-3 * expected) << info.name;
                EXPECT_NEAR(squares[axis] / n, variance, 2e-3 * variance) << info.name;
            }
            EXPECT_NEAR(product / n, 0, 2e-3 * variance) << info.name;
        }
    }
}

TEST(Filter, KnownSecondMoments) {
    EXPECT_NEAR(secondMoment(kPixelFilters[0]), 1.0 / 3, 1e-8);
    EXPECT_NEAR(secondMoment(kPixelFilters[1]), 1.0 / 6, 1e-8);
    // Integral of t^2 times the cosine series: 1/3 a0 + 2/pi^2 (a1 - a2/4 + a3/9), over a0.
    const double pi = std::acos(-1.0);
    const double series = 0.35875 / 3 - 2 / (pi * pi) * (0.48829 - 0.14128 / 4 + 0.01168 / 9);
    EXPECT_NEAR(secondMoment(kPixelFilters[3]), series / 0.35875, 1e-8);
}

TEST(Filter, NamesFindTheirFilters) {
    for (std::size_t kind = 0; kind < kFilterCount; ++kind)
        EXPECT_EQ(filterKind(kPixelFilters[kind].name), static_cast<FilterKind>(kind));
    EXPECT_FALSE(filterKind("mitchell").has_value());
}

}  // namespace
}  // namespace sss
