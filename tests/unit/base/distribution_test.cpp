#include "sss/base/distribution.h"

#include "sss/base/rng.h"

#include <gtest/gtest.h>

#include <vector>

namespace sss {
namespace {

TEST(Distribution, MassesFollowTheWeights) {
    const std::vector<double> weights{0, 3, 0, 1, 4, 0};
    const PiecewiseConstant1D distribution(weights);
    EXPECT_EQ(distribution.total(), 8);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        EXPECT_FLOAT_EQ(distribution.mass(i), static_cast<float>(weights[i] / 8));
        const float middle = (static_cast<float>(i) + 0.5f) / 6;
        EXPECT_FLOAT_EQ(distribution.pdf(middle), static_cast<float>(weights[i] / 8 * 6));
    }
}

TEST(Distribution, NeverChoosesACellWithoutWeight) {
    const PiecewiseConstant1D distribution(std::vector<double>{0, 1e-3, 0, 0, 2, 0, 0});
    for (const float u : {0.0f, 0x1p-24f, 0.0004997f, 0.0005f, 0.5f, 0x1.fffffep-1f}) {
        const auto sample = distribution.sample(u);
        EXPECT_TRUE(sample.cell == 1 || sample.cell == 4) << u;
        EXPECT_GT(sample.pdf, 0);
        EXPECT_EQ(sample.pdf, distribution.pdf(sample.x)) << u;
        EXPECT_LT(sample.x, 1.0f);
        EXPECT_LT(sample.within, 1.0f);
    }
}

TEST(Distribution, SamplesLieInTheirCellWhateverTheRounding) {
    Rng rng(3);
    std::vector<double> weights(4093);
    for (double& weight : weights) weight = rng.uniformDouble() < 0.3 ? 0 : rng.uniformDouble();
    const PiecewiseConstant1D distribution(weights);
    double total = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) total += double{distribution.mass(i)};
    EXPECT_NEAR(total, 1, 1e-6);
    for (int i = 0; i < 100000; ++i) {
        const auto sample = distribution.sample(rng.uniform());
        ASSERT_EQ(sample.pdf, distribution.pdf(sample.x));
        ASSERT_GT(weights[sample.cell], 0);
    }
}

TEST(Distribution, AllZeroIsUniform) {
    const PiecewiseConstant1D distribution(std::vector<double>{0, 0, 0, 0});
    EXPECT_FLOAT_EQ(distribution.pdf(0.9f), 1);
    EXPECT_FLOAT_EQ(distribution.sample(0.6f).x, 0.6f);
    const PiecewiseConstant2D square(2, std::vector<double>(6, 0.0));
    EXPECT_FLOAT_EQ(square.pdf({0.3f, 0.7f}), 1);
}

TEST(Distribution, SquareIsSampledByItsWeights) {
    // Chi-square over the cells; the row of zeros is never entered.
    const std::vector<double> weights{1, 2, 3, 0, 0, 0, 5, 0.5, 2, 0, 0, 4};
    const PiecewiseConstant2D distribution(3, weights);
    std::vector<double> counts(12, 0.0);
    Rng rng(11);
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
        const auto sample = distribution.sample(rng.uniform2());
        ASSERT_EQ(sample.pdf, distribution.pdf(sample.position));
        const auto x = static_cast<std::size_t>(sample.position.x * 3);
        const auto y = static_cast<std::size_t>(sample.position.y * 4);
        ++counts[y * 3 + x];
    }
    double chi2 = 0;
    for (std::size_t i = 0; i < 12; ++i) {
        const double expected = n * weights[i] / 17.5;
        if (expected == 0)
            EXPECT_EQ(counts[i], 0);
        else
            chi2 += (counts[i] - expected) * (counts[i] - expected) / expected;
    }
    EXPECT_LT(chi2, 22);  // 6 degrees of freedom: exceeded once in a thousand seeds
}

}  // namespace
}  // namespace sss
