#include "sss/light/mesh_light.h"

#include "sss/base/rng.h"
#include "unit/light/light_checks.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::cornerFactor;
using testing::expectDistributed;
using testing::irradiance;

/// The rectangle [-10, 10] x [-4, 4] at z = 5, facing down, in three unequal triangles and one
/// without area.
std::vector<MeshLight::Triangle> ceiling() {
    const Vec3 a{-10, -4, 5}, b{10, -4, 5}, c{10, 4, 5}, d{-10, 4, 5}, e{3, 4, 5};
    return {{a, e, b}, {a, a, b}, {b, e, c}, {a, d, e}};
}

TEST(MeshLight, IrradianceMatchesTheClosedForm) {
    const MeshLight light(ceiling(), {{2, 2, 2}, false});
    EXPECT_DOUBLE_EQ(light.areaMm2(), 160);
    const double expected = 2 * kPi * 4 * cornerFactor(10, 4, 5);
    EXPECT_NEAR(irradiance(light, {0, 0, 0}, {0, 0, 1}), expected, 4e-3 * expected);
    EXPECT_EQ(irradiance(light, {0, 0, 10}, {0, 0, -1}), 0);
    const MeshLight both(ceiling(), {{2, 2, 2}, true});
    EXPECT_NEAR(irradiance(both, {0, 0, 10}, {0, 0, -1}), expected, 4e-3 * expected);
}

TEST(MeshLight, DensityForAHitIsTheSamples) {
    const MeshLight light(ceiling(), {{1, 1, 1}, false});
    const Vec3 from{1, 2, -3}, normal{0, 0, -1};
    double solidAngle = 0;
    const std::uint32_t n = 1 << 14;
    for (std::uint32_t i = 0; i < n; ++i) {
        const LightSample s = light.sample(from, Sampler(1, i).next2D());
        const Vec3 hit = from + s.distance * s.direction;
        EXPECT_NEAR(hit.z, 5, 1e-4);
        EXPECT_LE(std::abs(hit.x), 10.001f);
        EXPECT_LE(std::abs(hit.y), 4.001f);
        EXPECT_NEAR(light.pdfForHit(from, hit, normal), s.pdf, 1e-4f * s.pdf);
        EXPECT_EQ(s.radiance, light.radianceTowards(s.direction, normal));
        solidAngle += 1 / static_cast<double>(s.pdf) / n;
    }
    // The rectangle's own closed form, corner by corner of [-11, 9] x [-6, 2] at 8.
    const auto corner = [](double x, double y) {
        return std::atan(x * y / (8 * std::sqrt(x * x + y * y + 64)));
    };
    const double exact = corner(9, 2) - corner(-11, 2) - corner(9, -6) + corner(-11, -6);
    EXPECT_NEAR(solidAngle, exact, 2e-3 * exact);
    EXPECT_EQ(light.pdfForHit({0, 0, 9}, {0, 0, 5}, normal), 0);
    EXPECT_EQ(light.radianceTowards({0, 0, -1}, normal), Rgb(0.0f));
    EXPECT_EQ(light.seen(from, {0, 0, 1}).pdf, 0);
}

TEST(MeshLight, PointsAreUniformByArea) {
    const MeshLight light(ceiling(), {{1, 1, 1}, false});
    const int n = 40000;
    std::vector<double> counts(10 * 4, 0.0);
    const std::vector<double> expected(10 * 4, n / 40.0);
    Rng rng(14);
    for (int s = 0; s < n; ++s) {
        const LightSample sample = light.sample({0, 0, 0}, rng.uniform2());
        const Vec3 hit = sample.distance * sample.direction;
        const int i = std::clamp(static_cast<int>((hit.x + 10) / 2), 0, 9);
        const int j = std::clamp(static_cast<int>((hit.y + 4) / 2), 0, 3);
        ++counts[static_cast<std::size_t>(j * 10 + i)];
    }
    expectDistributed(counts, expected);
}

}  // namespace
}  // namespace sss
