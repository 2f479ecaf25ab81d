// Systems that can be solved otherwise.
#include "sss/shape/gmres.h"

#include "sss/base/rng.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

constexpr std::size_t kSize = 24;

// A well-conditioned matrix a channel, and what it makes of a known vector.
struct System {
    std::vector<DRgb> matrix, solution, right;

    System() : matrix(kSize * kSize), solution(kSize), right(kSize) {
        Rng rng(3);
        const auto number = [&] { return rng.uniformDouble() - 0.5; };
        for (std::size_t i = 0; i < kSize; ++i) {
            solution[i] = DRgb(number(), number(), number());
            for (std::size_t j = 0; j < kSize; ++j)
                matrix[i * kSize + j] =
                    0.3 * DRgb(number(), number(), number()) + DRgb(i == j ? 1.0 : 0.0);
        }
        apply(solution, right);
    }
    void apply(std::span<const DRgb> in, std::span<DRgb> out) const {
        for (std::size_t i = 0; i < kSize; ++i) {
            out[i] = DRgb(0);
            for (std::size_t j = 0; j < kSize; ++j) out[i] += matrix[i * kSize + j] * in[j];
        }
    }
    GmresReport solve(std::span<DRgb> x, double tolerance, int most = 100) const {
        return gmres(
            [&](std::span<const DRgb> in, const DRgb&, std::span<DRgb> out) { apply(in, out); },
            right, x, tolerance, most);
    }
};

TEST(Gmres, SolvesAllChannels) {
    const System system;
    std::vector<DRgb> x(kSize, DRgb(0));
    const GmresReport report = system.solve(x, 1e-12);
    EXPECT_TRUE(report.converged);
    EXPECT_NEAR(report.start.x, 1, 1e-12);  // of a guess of 0
    EXPECT_LE(report.iterations, static_cast<int>(kSize) + 2);
    for (std::size_t i = 0; i < kSize; ++i)
        EXPECT_LT(glm::length(x[i] - system.solution[i]), 1e-10);
}

TEST(Gmres, AGoodGuessNeedsOneProduct) {
    const System system;
    std::vector<DRgb> x = system.solution;
    const GmresReport report = system.solve(x, 1e-9);
    EXPECT_EQ(report.iterations, 1);
    EXPECT_LT(report.start.x, 1e-9);
}

TEST(Gmres, SaysWhatItLeft) {
    const System system;
    std::vector<DRgb> x(kSize, DRgb(0)), rest(kSize);
    const GmresReport report = system.solve(x, 1e-12, 5);
    EXPECT_FALSE(report.converged);
    system.apply(x, rest);
    DRgb left{0}, size{0};
    for (std::size_t i = 0; i < kSize; ++i) {
        left += (rest[i] - system.right[i]) * (rest[i] - system.right[i]);
        size += system.right[i] * system.right[i];
    }
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(report.residual[c], std::sqrt(left[c] / size[c]), 1e-10);
}

TEST(Gmres, ChannelsWithoutLightAreDark) {
    System system;
    for (DRgb& v : system.right) v.y = 0;
    std::vector<DRgb> x(kSize, DRgb(1));
    EXPECT_TRUE(system.solve(x, 1e-12).converged);
    for (std::size_t i = 0; i < kSize; ++i) {
        EXPECT_EQ(x[i].y, 0);
        EXPECT_NEAR(x[i].x, system.solution[i].x, 1e-10);
    }
}

}  // namespace
}  // namespace sss
