#pragma once
#include "sss/base/sampler.h"
#include "sss/light/light.h"

#include <gtest/gtest.h>

#include <vector>

namespace sss::testing {

/// Configuration factor of a patch to a parallel rectangle a x b at distance c, the patch's normal
/// passing through a corner (Howell's catalogue, B-4).
inline double cornerFactor(double a, double b, double c) {
    const double x = a / c, y = b / c;
    const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
    return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * kPi);
}

/// Irradiance (red) at `from` on a patch of unit normal `normal`, from 2^14 samples.
inline double irradiance(const Light& light, const Vec3& from, const Vec3& normal) {
    const std::uint32_t n = 1 << 14;
    double sum = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const LightSample s = light.sample(from, Sampler(21, i).next2D());
        const float cosine = glm::dot(s.direction, normal);
        if (s.pdf > 0 && cosine > 0) sum += static_cast<double>(s.radiance.x * cosine / s.pdf);
    }
    return sum / n;
}

/// What a ray in a sampled direction sees is what the sample said: radiance, density, distance.
/// Rays that rounding carries past the light's edge may miss; few of them do.
inline void expectSeenAgrees(const Light& light, const Vec3& from, float tolerance = 1e-4f) {
    const std::uint32_t n = 2000;
    std::uint32_t misses = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const LightSample s = light.sample(from, Sampler(5, i).next2D());
        ASSERT_GT(s.pdf, 0);
        ASSERT_NEAR(glm::length(s.direction), 1, 1e-5);
        const Light::Seen seen = light.seen(from, s.direction);
        if (seen.pdf == 0) {
            ++misses;
            continue;
        }
        ASSERT_NEAR(seen.pdf, s.pdf, tolerance * s.pdf);
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(seen.radiance[c], s.radiance[c], tolerance * (1 + s.radiance[c]));
        if (std::isinf(s.distance))
            ASSERT_EQ(seen.distance, s.distance);
        else
            ASSERT_NEAR(seen.distance, s.distance, 2e-3f * s.distance);
    }
    EXPECT_LE(misses, n / 100);
}

/// Chi-square of counts against expectations; within 4 standard deviations of its mean.
inline void expectDistributed(const std::vector<double>& counts,
                              const std::vector<double>& expected) {
    double chi2 = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        ASSERT_GT(expected[i], 0);
        chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    }
    const double freedom = static_cast<double>(counts.size() - 1);
    EXPECT_LT(chi2, freedom + 4 * std::sqrt(2 * freedom));
}

}  // namespace sss::testing
