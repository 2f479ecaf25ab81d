#include "sss/light/sphere_light.h"

#include "sss/base/rng.h"
#include "unit/light/light_checks.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::expectDistributed;
using testing::expectSeenAgrees;
using testing::irradiance;

const SphereLight kSphere{{0, 0, 30}, 2, {3, 3, 3}};

TEST(SphereLight, IrradianceMatchesTheClosedForm) {
    const SphereLightSource light(kSphere, {});
    for (const Vec3& from : {Vec3{0, 0, 0}, Vec3{0, 0, 27.9f}, Vec3{0, 0, -5000}}) {
        const double ratio = 2.0 / static_cast<double>(30 - from.z);
        const double facing = kPi * 3 * ratio * ratio;
        EXPECT_NEAR(irradiance(light, from, {0, 0, 1}), facing, 2e-3 * facing) << from.z;
        const Vec3 tilted = glm::normalize(Vec3{1, 0, 2});
        if (from.z > 27) continue;  // the tilted patch would see only part of it
        EXPECT_NEAR(irradiance(light, from, tilted), facing * static_cast<double>(tilted.z),
                    2e-3 * facing);
    }
}

TEST(SphereLight, SamplesAreUniformInTheCone) {
    const SphereLightSource light(kSphere, {});
    const Vec3 from{1, -2, 20};
    const DVec3 axis = glm::normalize(DVec3{-1, 2, 10});
    const double sin2 = 4 / (1.0 + 4 + 100), height = 1 - std::sqrt(1 - sin2);
    const int rings = 8, sectors = 8, n = 40000;
    std::vector<double> counts(rings * sectors, 0.0);
    const std::vector<double> expected(rings * sectors, n / double{rings * sectors});
    Rng rng(12);
    const Frame frame{Vec3(axis)};
    for (int s = 0; s < n; ++s) {
        const Vec3 local = frame.toLocal(light.sample(from, rng.uniform2()).direction);
        const double level = (1 - static_cast<double>(local.z)) / height;
        const double turn = std::atan2(local.y, local.x) / (2 * kPi) + 0.5;
        const int i = std::clamp(static_cast<int>(level * rings), 0, rings - 1);
        const int j = std::clamp(static_cast<int>(turn * sectors), 0, sectors - 1);
        ++counts[static_cast<std::size_t>(i * sectors + j)];
    }
    expectDistributed(counts, expected);
}

TEST(SphereLight, SeenAgreesNearAndFar) {
    const SphereLightSource light(kSphere, {0, 0, 10});
    expectSeenAgrees(light, {0, 0, 0});
    expectSeenAgrees(light, {0.1f, 0, 17.9f});
    expectSeenAgrees(light, {100, 50, -20});
}

TEST(SphereLight, InsideThereIsNothing) {
    const SphereLightSource light(kSphere, {});
    EXPECT_EQ(light.sample({0, 0, 30}, {0.5f, 0.5f}).pdf, 0);
    EXPECT_EQ(light.sample({0, 1.9f, 30}, {0.5f, 0.5f}).pdf, 0);
    EXPECT_EQ(light.seen({0, 0, 30}, {0, 0, 1}).pdf, 0);
    EXPECT_EQ(light.seen({0, 0, 0}, {0, 0, -1}).pdf, 0);
    EXPECT_FLOAT_EQ(light.seen({0, 0, 0}, {0, 0, 1}).distance, 28);
}

}  // namespace
}  // namespace sss
