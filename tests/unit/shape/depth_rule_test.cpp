// Two places a beam against the exponential that they stand for.
#include "sss/shape/depth_rule.h"

#include "sss/medium/measured_media.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sss {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

DiffusionConstants constantsOf(const DRgb& sigmaSPrime) {
    Medium medium;
    medium.sigmaS = sigmaSPrime;
    medium.sigmaA = DRgb(0.01);
    medium.eta = 1.4;
    return diffusionConstants(medium, exactFresnelMoments(1.4));
}

// Sum of weight x f(depth), by channel.
template <typename Function>
DRgb sum(const DiffusionConstants& medium, double length, const Function& f) {
    std::vector<DepthRule::Node> nodes;
    DepthRule(medium).append(length, nodes);
    DRgb total{0};
    for (const DepthRule::Node& node : nodes) {
        EXPECT_GE(node.depthMm, 0);
        EXPECT_LE(node.depthMm, length);
        for (int c = 0; c < 3; ++c) EXPECT_GE(node.weight[c], 0);
        total += node.weight * f(node.depthMm);
    }
    return total;
}

TEST(DepthRule, KeepsLightAndMeanDepth) {
    for (const DRgb& scattering : {DRgb(2), DRgb(2, 2.6, 3), DRgb(0.1, 1, 30)})
        for (const double length : {0.01, 0.3, 1.0, 4.0, 50.0, kEndless}) {
            const DiffusionConstants medium = constantsOf(scattering);
            const DRgb light = sum(medium, length, [](double) { return 1.0; });
            const DRgb depth = sum(medium, length, [](double s) { return s; });
            for (int c = 0; c < 3; ++c) {
                const double sigma = medium.extinction[c], x = std::min(sigma * length, 700.0);
                EXPECT_NEAR(light[c], -std::expm1(-x), 2e-6);
                EXPECT_NEAR(depth[c] * sigma, -std::expm1(-x) - x * std::exp(-x),
                            3e-5 * std::min(1.0, x * x));
            }
        }
}

// What a source at a depth gives off to the surface falls as exp(-k s): the rule's own error.
TEST(DepthRule, IsAccurateWhateverTheAbsorption) {
    for (const double absorption : {1e-3, 0.1, 0.8, 5.0}) {
        Medium absorbing;
        absorbing.sigmaS = {2, 2.3, 2.6};
        absorbing.sigmaA = DRgb(absorption);
        const DiffusionConstants medium = diffusionConstants(absorbing, exactFresnelMoments(1));
        const double k = medium.screening.y / medium.extinction.y;
        const DRgb value =
            sum(medium, kEndless, [&](double s) { return std::exp(-k * medium.extinction.y * s); });
        for (int c = 0; c < 3; ++c) {
            const double exact = 1 / (1 + k * medium.extinction.y / medium.extinction[c]);
            EXPECT_NEAR(value[c] / exact, 1, k < 0.25 ? 1e-3 : 2.5e-3) << k;
        }
    }
}

TEST(DepthRule, LeavesOutChannelsThatDoNotScatter) {
    Medium medium;
    medium.sigmaS = {1, 0, 2};
    medium.sigmaA = DRgb(0.5);
    const DiffusionConstants constants = diffusionConstants(medium, exactFresnelMoments(1));
    EXPECT_FALSE(constants.scatters[1]);
    EXPECT_EQ(sum(constants, kEndless, [](double) { return 1.0; }).y, 0);
    EXPECT_NEAR(sum(constants, kEndless, [](double) { return 1.0; }).x, 1, 2e-6);
}

}  // namespace
}  // namespace sss
