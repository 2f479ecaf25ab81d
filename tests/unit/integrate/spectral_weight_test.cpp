#include "sss/integrate/spectral_weight.h"

#include "unit/integrate/batches.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

MediumCoefficients coloured() {
    Medium medium;
    medium.sigmaS = {0.5, 2, 7};
    medium.sigmaA = {0.1, 1, 0};
    medium.g = {0.8, 0, -0.5};
    return MediumCoefficients(medium);
}

// One collision after another, whoever leads: the mean weight of each channel is its albedo's
// power, and no weight exceeds 3.
TEST(SpectralWeight, MeansOfManyCollisions) {
    const MediumCoefficients medium = coloured();
    constexpr int kCollisions = 4;
    float largest = 0;
    const testing::Estimate e = testing::batchEstimate(5, 1024, [&](Sampler& sampler) {
        SpectralWeight weight(std::min(2, static_cast<int>(3 * sampler.next1D())));
        Vec3 along(0, 0, 1);
        for (int k = 0; k < kCollisions; ++k) {
            collide(medium, sampleFreePath(medium, weight.hero(), sampler.next1D()), weight);
            along = scatter(medium, along, sampler.next2D(), weight);
        }
        largest = std::max(largest, maxComponent(weight.value()));
        return DRgb(weight.value());
    });
    for (int c = 0; c < 3; ++c) {
        const double albedo = static_cast<double>(medium.sigmaS[c] / medium.sigmaT[c]);
        EXPECT_NEAR(e.mean[c], std::pow(albedo, kCollisions), 3 * e.error[c] + 1e-6) << c;
        EXPECT_LT(e.error[c], 0.02);
    }
    EXPECT_LE(largest, 3.0001f);
}

// The share that passes a layer is Beer's and Lambert's.
TEST(SpectralWeight, MeansOfWhatPasses) {
    const MediumCoefficients medium = coloured();
    const float thickness = 0.4f;
    const testing::Estimate e = testing::batchEstimate(6, 512, [&](Sampler& sampler) {
        SpectralWeight weight(std::min(2, static_cast<int>(3 * sampler.next1D())));
        if (sampleFreePath(medium, weight.hero(), sampler.next1D()) < thickness) return DRgb(0);
        passThrough(medium, thickness, weight);
        return DRgb(weight.value());
    });
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(e.mean[c], std::exp(-static_cast<double>(medium.sigmaT[c]) * 0.4),
                    3 * e.error[c] + 1e-6);
}

// Products that leave the range of float do not matter: only their ratios do.
TEST(SpectralWeight, LongPaths) {
    Medium white;
    white.sigmaS = {1, 10, 100};
    const MediumCoefficients medium(white);
    SpectralWeight weight(0);
    for (int k = 0; k < 10000; ++k) collide(medium, 1.0f, weight);
    EXPECT_TRUE(isFinite(weight.value()));
    EXPECT_NEAR(weight.value().x, 3, 1e-3);
    EXPECT_EQ(weight.value().z, 0);
}

}  // namespace
}  // namespace sss
