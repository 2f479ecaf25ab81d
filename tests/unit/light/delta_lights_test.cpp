#include "sss/base/sampler.h"
#include "sss/light/directional_light.h"
#include "sss/light/point_light.h"
#include "sss/light/spot_light.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

TEST(PointLight, IrradianceFallsWithTheSquareInMetres) {
    const PointLightSource light({{1000, 2000, 3000}, {5, 10, 20}}, {1000, 2000, 0});
    const LightSample s = light.sample({0, 0, 1000}, {0.5f, 0.5f});  // 2 m away
    EXPECT_EQ(s.direction, Vec3(0, 0, 1));
    EXPECT_FLOAT_EQ(s.distance, 2000);
    EXPECT_FLOAT_EQ(s.radiance.x, 1.25f);
    EXPECT_FLOAT_EQ(s.radiance.z, 5);
    EXPECT_EQ(s.pdf, 1);
    EXPECT_TRUE(light.isDelta());
    EXPECT_FALSE(light.isInfinite());
    EXPECT_EQ(light.sample({0, 0, 3000}, {}).pdf, 0);  // on the light itself
    EXPECT_EQ(light.seen({0, 0, 0}, {0, 0, 1}).pdf, 0);
}

TEST(PointLight, FarFromTheWorldsOriginItKeepsItsPlace) {
    const DVec3 far{1e8, -1e8, 1e8};
    const PointLightSource light({far + DVec3{0, 0, 0.5}, {1, 1, 1}}, far);
    EXPECT_FLOAT_EQ(light.sample({0, 0, 0}, {}).distance, 0.5f);
}

TEST(PointLight, ImportanceIsTheIrradianceAndFiniteInside) {
    const PointLightSource light({{0, 0, 0}, {2, 2, 2}}, {});
    Bounds far;
    far.add(Vec3{999, -1, -1});
    far.add(Vec3{1001, 1, 1});
    EXPECT_NEAR(light.importance(far), 2, 1e-4);
    Bounds around;
    around.add(Vec3{-1.0f});
    around.add(Vec3{1.0f});
    EXPECT_TRUE(std::isfinite(light.importance(around)));
}

TEST(SpotLight, HasAConeWithASmoothEdge) {
    const SpotLightSource light({{0, 0, 0}, {0, 0, -7}, {4, 4, 4}, 30, 10}, {});
    const auto irradiance = [&](double degrees) {
        const double a = degrees * kPi / 180;
        return light.sample(Vec3(DVec3{1000 * std::sin(a), 0, -1000 * std::cos(a)}), {}).radiance.x;
    };
    EXPECT_FLOAT_EQ(irradiance(0), 4);
    EXPECT_FLOAT_EQ(irradiance(19.9), 4);
    EXPECT_EQ(irradiance(30.1), 0);
    EXPECT_EQ(irradiance(170), 0);
    float before = 4;
    for (double degrees = 20; degrees < 30; degrees += 0.25) {
        const float now = irradiance(degrees);
        EXPECT_LE(now, before + 1e-5f);
        EXPECT_LT(before - now, 0.3f);
        before = now;
    }
    // Half way in the cosine.
    const double middle = 0.5 * (std::cos(kPi / 9) + std::cos(kPi / 6));
    EXPECT_NEAR(irradiance(std::acos(middle) * 180 / kPi), 2, 1e-3);
}

TEST(SpotLight, ImportanceIsZeroOutsideTheCone) {
    const SpotLightSource light({{0, 0, 0}, {0, 0, -1}, {1, 1, 1}, 30, 5}, {});
    Bounds inside, touching, outside;
    inside.add(Vec3{0, 0, -100});
    outside.add(Vec3{100, 0, 0});
    touching.add(Vec3{60, -10, -110});
    touching.add(Vec3{80, 10, -90});
    EXPECT_GT(light.importance(inside), 0);
    EXPECT_GT(light.importance(touching), 0);
    EXPECT_EQ(light.importance(outside), 0);
}

TEST(DirectionalLight, ComesFromFarAway) {
    const DirectionalLightSource light({{0, -3, 0}, {1, 2, 3}});
    const LightSample s = light.sample({5, 6, 7}, {});
    EXPECT_EQ(s.direction, Vec3(0, 1, 0));
    EXPECT_TRUE(std::isinf(s.distance));
    EXPECT_EQ(s.radiance, Rgb(1, 2, 3));
    EXPECT_TRUE(light.isDelta());
    EXPECT_TRUE(light.isInfinite());
}

// The part of a ray in the cone is where sample() finds light; rays of all kinds, from within too.
TEST(SpotLight, SaysWhereItShinesAlongARay) {
    const SpotLightSource light({{1, 2, 3}, {4, -1, 1}, Rgb(1), 25, 5}, DVec3(0));
    int crossed = 0;
    for (std::uint32_t i = 0; i < 400; ++i) {
        Sampler sampler(9, i);
        const Vec2 u = sampler.next2D(), v = sampler.next2D();
        const float w = sampler.next1D();
        const Vec3 from = Vec3(u.x, u.y, w) * 10.0f - 3.0f;
        const Vec3 along = glm::normalize(Vec3(v.x - 0.5f, v.y - 0.5f, w - 0.4f));
        const Light::Stretch lit = light.litStretch(from, along, {0.5f, 20});
        crossed += lit.begin < lit.end ? 1 : 0;
        for (int k = 0; k < 200; ++k) {
            const float t = 0.5f + 19.5f * (static_cast<float>(k) + 0.5f) / 200;
            const bool isLit = light.sample(from + along * t, {}).pdf > 0;
            const bool isIn = t > lit.begin && t < lit.end;
            // Rounding decides within a thousandth of the ends.
            if (std::abs(t - lit.begin) < 1e-3f || std::abs(t - lit.end) < 1e-3f) continue;
            ASSERT_EQ(isIn, isLit) << i << " at " << t;
        }
    }
    EXPECT_GT(crossed, 40);
    EXPECT_LT(crossed, 360);
}

}  // namespace
}  // namespace sss
