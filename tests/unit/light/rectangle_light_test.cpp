#include "sss/light/rectangle_light.h"

#include "sss/base/rng.h"
#include "unit/light/light_checks.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::cornerFactor;
using testing::expectDistributed;
using testing::expectSeenAgrees;
using testing::irradiance;

RectangleLight ceiling(double width, double height, double distance) {
    return {{0, 0, distance}, {0, 0, 0}, {0, 1, 0}, width, height, {2, 2, 2}, false};
}

TEST(RectangleLight, IrradianceOfAParallelPatchMatchesTheClosedForm) {
    for (const double distance : {0.01, 1.0, 10.0, 300.0, 20000.0}) {
        const RectangleLightSource light(ceiling(20, 8, distance), {});
        const double expected = 2 * kPi * 4 * cornerFactor(10, 4, distance);
        EXPECT_NEAR(irradiance(light, {0, 0, 0}, {0, 0, 1}), expected, 2e-3 * expected) << distance;
    }
}

TEST(RectangleLight, OffCentrePatchByAdditionOfCorners) {
    // The patch sees the rectangle [3, 23] x [1, 9] at 5 above it.
    const RectangleLightSource light(ceiling(20, 8, 5), {});
    const double factor = cornerFactor(23, 9, 5) - cornerFactor(3, 9, 5) - cornerFactor(23, 1, 5) +
                          cornerFactor(3, 1, 5);
    const double expected = 2 * kPi * factor;
    EXPECT_NEAR(irradiance(light, {-13, -5, 0}, {0, 0, 1}), expected, 2e-3 * expected);
}

TEST(RectangleLight, SolidAngleMatchesQuadrature) {
    for (const RectangleView& view :
         {RectangleView{-1, 1, -1, 1, 1}, RectangleView{2, 5, -1, 3, 0.2},
          RectangleView{-4, -3, -2, -1, 10}, RectangleView{0, 1, 0, 1, 0.5}}) {
        const int n = 2000;
        double sum = 0;
        const double dx = (view.x1 - view.x0) / n, dy = (view.y1 - view.y0) / n;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const double x = view.x0 + (i + 0.5) * dx, y = view.y0 + (j + 0.5) * dy;
                const double d2 = x * x + y * y + view.height * view.height;
                sum += view.height / (d2 * std::sqrt(d2)) * dx * dy;
            }
        EXPECT_NEAR(SphericalRectangle(view).solidAngle(), sum, 1e-5 * sum);
    }
}

TEST(RectangleLight, SamplesAreUniformInSolidAngle) {
    for (const RectangleView& view :
         {RectangleView{-1, 1, -1, 1, 1}, RectangleView{2, 5, -1, 3, 0.2},
          RectangleView{0, 3, -2, 0, 0.01}, RectangleView{-40, -39, 30, 32, 5}}) {
        const SphericalRectangle rectangle(view);
        const int cells = 6, n = 50000;
        const double dx = (view.x1 - view.x0) / cells, dy = (view.y1 - view.y0) / cells;
        std::vector<double> expected, counts(cells * cells, 0.0);
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i) {
                const SphericalRectangle cell({view.x0 + i * dx, view.x0 + (i + 1) * dx,
                                               view.y0 + j * dy, view.y0 + (j + 1) * dy,
                                               view.height});
                expected.push_back(n * cell.solidAngle() / rectangle.solidAngle());
            }
        Rng rng(6);
        for (int s = 0; s < n; ++s) {
            const DVec2 p = rectangle.sample({rng.uniformDouble(), rng.uniformDouble()});
            const int i = std::min(cells - 1, static_cast<int>((p.x - view.x0) / dx));
            const int j = std::min(cells - 1, static_cast<int>((p.y - view.y0) / dy));
            ++counts[static_cast<std::size_t>(j * cells + i)];
        }
        expectDistributed(counts, expected);
    }
}

TEST(RectangleLight, SeenAgreesWithSamples) {
    const RectangleLight settings{{10, 50, 3}, {1, 2, 3}, {0, 1, 0.3}, 30, 12, {1, 2, 3}, true};
    const RectangleLightSource light(settings, {5, 5, 5});
    expectSeenAgrees(light, {0, 0, 0});
    expectSeenAgrees(light, {4, 40, -3});       // close
    expectSeenAgrees(light, {10, 80, 0});       // behind; it is two-sided
    expectSeenAgrees(light, {3000, -9000, 0});  // so far that it is sampled by area
}

TEST(RectangleLight, SamplesTogetherAreThoseOfEachAlone) {
    Rng rng(12);
    const auto within = [&](float size) {
        return size * (Vec3{rng.uniform(), rng.uniform(), rng.uniform()} - 0.5f);
    };
    int shining = 0;
    for (int scene = 0; scene < 400; ++scene) {
        // From where the lamp is large to where it is tiny, in front of it and behind.
        const float far = scene % 4 == 0 ? 3000.0f : 250.0f;
        RectangleLight settings{DVec3(within(far)), {0, 0, 0}, {0.3, 1, 0}, 90, 160,
                                {1, 2, 3},          false};
        settings.twoSided = scene % 3 == 0;
        const RectangleLightSource light(settings, {});
        std::vector<Vec3> from;
        std::vector<Vec2> u;
        for (int i = 0; i < 1 + scene % 37; ++i) {
            from.push_back(within(100));
            u.push_back(rng.uniform2());
        }
        std::vector<LightSample> together(from.size());
        light.sampleTogether(from, u, together);
        for (std::size_t i = 0; i < from.size(); ++i) {
            const LightSample alone = light.sample(from[i], u[i]);
            ASSERT_EQ(together[i].pdf > 0, alone.pdf > 0);
            if (!(alone.pdf > 0)) continue;
            ++shining;
            ASSERT_NEAR(together[i].pdf, alone.pdf, 1e-6 * alone.pdf);
            ASSERT_NEAR(glm::distance(together[i].direction, alone.direction), 0, 2e-6);
            ASSERT_NEAR(together[i].distance, alone.distance, 3e-6 * alone.distance);
            ASSERT_EQ(together[i].radiance, alone.radiance);
        }
    }
    EXPECT_GT(shining, 3000);
}

TEST(RectangleLight, OneSidedShinesForwardOnly) {
    const RectangleLightSource light(ceiling(2, 2, 10), {});
    EXPECT_GT(light.sample({0, 0, 0}, {0.5f, 0.5f}).pdf, 0);
    EXPECT_EQ(light.sample({0, 0, 20}, {0.5f, 0.5f}).pdf, 0);
    EXPECT_EQ(light.sample({5, 0, 10}, {0.5f, 0.5f}).pdf, 0);  // in its plane
    EXPECT_EQ(light.seen({0, 0, 20}, {0, 0, -1}).pdf, 0);
    EXPECT_EQ(light.seen({0, 0, 0}, {0, 0, -1}).pdf, 0);
    EXPECT_EQ(light.seen({3, 0, 0}, {0, 0, 1}).pdf, 0);
    EXPECT_FLOAT_EQ(light.seen({0.5f, 0, 0}, {0, 0, 1}).distance, 10);
    Bounds behind, front;
    behind.add(Vec3{0, 0, 20});
    front.add(Vec3{0, 0, 0});
    EXPECT_EQ(light.importance(behind), 0);
    EXPECT_NEAR(light.importance(front), 2 * 4 / 100.0, 1e-6);
}

TEST(RectangleLight, WidthLiesAcrossUp) {
    // Facing -z with up = y: wide in x, high in y. With up along the normal it still is a
    // rectangle.
    const RectangleLightSource light(ceiling(10, 1, 5), {});
    EXPECT_GT(light.seen({4, 0, 0}, {0, 0, 1}).pdf, 0);
    EXPECT_EQ(light.seen({0, 4, 0}, {0, 0, 1}).pdf, 0);
    RectangleLight odd = ceiling(10, 1, 5);
    odd.up = {0, 0, 3};
    expectSeenAgrees(RectangleLightSource(odd, {}), {1, 2, 0});
}

}  // namespace
}  // namespace sss
