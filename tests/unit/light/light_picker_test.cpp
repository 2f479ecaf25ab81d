#include "sss/light/light_picker.h"

#include "sss/base/rng.h"
#include "sss/base/sampler.h"
#include "sss/light/light_table.h"
#include "sss/light/mesh_light.h"

#include <gtest/gtest.h>

#include <vector>

namespace sss {
namespace {

std::vector<std::unique_ptr<Light>> someLights() {
    const LightSettings all[] = {
        PointLight{{0, 0, 1000}, {1, 1, 1}},
        SpotLight{{0, 0, 1000}, {0, 0, 2000}, {5, 5, 5}, 20, 5},  // looks away
        DirectionalLight{{0, 0, -1}, {2, 2, 2}},
        RectangleLight{{0, 0, 100}, {0, 0, 0}, {0, 1, 0}, 10, 10, {3, 3, 3}, false},
        SphereLight{{0, 50, 0}, 5, {4, 4, 4}},
        EnvironmentLight{{0.1f, 0.1f, 0.1f}, {}, 0},
    };
    std::vector<std::unique_ptr<Light>> lights;
    for (const LightSettings& settings : all) lights.push_back(makeLight(settings, {}));
    return lights;
}

Bounds smallTarget() {
    Bounds target;
    target.add(Vec3{-1.0f});
    target.add(Vec3{1.0f});
    return target;
}

TEST(LightTable, MakesEveryKind) {
    const auto lights = someLights();
    const bool delta[] = {true, true, true, false, false, false};
    const bool infinite[] = {false, false, true, false, false, true};
    for (std::size_t i = 0; i < lights.size(); ++i) {
        EXPECT_EQ(lights[i]->isDelta(), delta[i]) << i;
        EXPECT_EQ(lights[i]->isInfinite(), infinite[i]) << i;
        EXPECT_EQ(std::isinf(lights[i]->sample({0, 0, 0}, {0.5f, 0.5f}).distance), infinite[i]);
    }
}

TEST(LightTable, OriginMovesPositions) {
    const auto light = makeLight(SphereLight{{100, 0, 0}, 1, {1, 1, 1}}, {100, 0, 50});
    EXPECT_FLOAT_EQ(light->seen({0, 0, 0}, {0, 0, -1}).distance, 49);
}

TEST(LightPicker, FollowsImportanceAboveAFloor) {
    const auto lights = someLights();
    const LightPicker picker(lights, smallTarget());
    EXPECT_FALSE(picker.empty());
    double total = 0, importance = 0;
    for (std::size_t i = 0; i < 5; ++i) {
        total += static_cast<double>(picker.pmf(i));
        importance += static_cast<double>(lights[i]->importance(smallTarget()));
    }
    EXPECT_NEAR(total, 1, 1e-6);
    for (std::size_t i = 0; i < 5; ++i) {
        const double share = static_cast<double>(lights[i]->importance(smallTarget())) / importance;
        EXPECT_NEAR(picker.pmf(i), 0.9 * share + 0.1 / 5, 1e-6) << i;
    }
    EXPECT_EQ(lights[1]->importance(smallTarget()), 0);
    EXPECT_GT(picker.pmf(1), 0.01f);
    // The constant environment is left to the scattered rays.
    EXPECT_TRUE(lights[5]->bestFoundByScattering());
    EXPECT_EQ(picker.pmf(5), 0);
}

TEST(LightPicker, PicksWithItsOwnProbabilities) {
    const auto lights = someLights();
    const LightPicker picker(lights, smallTarget());
    const int n = 100000;
    std::vector<double> counts(lights.size(), 0.0), means(lights.size(), 0.0);
    for (int i = 0; i < n; ++i) {
        const LightPicker::Pick pick = picker.pick((static_cast<float>(i) + 0.5f) / n);
        EXPECT_EQ(pick.pmf, picker.pmf(pick.index));
        ++counts[pick.index];
        means[pick.index] += static_cast<double>(pick.u);
    }
    for (std::size_t i = 0; i < lights.size(); ++i) {
        EXPECT_NEAR(counts[i] / n, static_cast<double>(picker.pmf(i)), 1e-4);
        // What is left is uniform again.
        if (counts[i] == 0) continue;
        EXPECT_NEAR(means[i] / counts[i], 0.5, 1e-2);
    }
}

TEST(LightPicker, NoLightsAndDarkLights) {
    EXPECT_TRUE(LightPicker({}, smallTarget()).empty());
    std::vector<std::unique_ptr<Light>> lights;
    lights.push_back(makeLight(EnvironmentLight{Rgb{1.0f}, {}, 0}, {}));
    EXPECT_TRUE(LightPicker(lights, smallTarget()).empty());
    lights.push_back(makeLight(SphereLight{{0, 9, 0}, 1, Rgb{0.0f}}, {}));
    lights.push_back(makeLight(SphereLight{{0, 9, 0}, 1, Rgb{0.0f}}, {}));
    const LightPicker dark(lights, smallTarget());
    EXPECT_EQ(dark.pmf(0), 0);
    EXPECT_FLOAT_EQ(dark.pmf(1), 0.5f);
    EXPECT_FLOAT_EQ(dark.pmf(2), 0.5f);
}

TEST(LightPicker, OneLightNeedsNoNumber) {
    std::vector<std::unique_ptr<Light>> lights;
    lights.push_back(makeLight(EnvironmentLight{{9, 9, 9}, {}, 0}, {}));  // found by scattering
    lights.push_back(makeLight(SphereLight{{0, 50, 0}, 5, {4, 4, 4}}, {}));
    const LightPicker picker(lights, smallTarget());
    EXPECT_FALSE(picker.hasChoice());
    EXPECT_EQ(picker.pick(0.3f).index, 1u);
    EXPECT_EQ(picker.pick(0.3f).pmf, 1.0f);
    EXPECT_EQ(picker.pmf(1), 1.0f);
    EXPECT_TRUE(LightPicker(someLights(), smallTarget()).hasChoice());
}

// Planes of all directions near and far: what a light sends never comes from below one that it is
// said to lie below, and about half of the planes are found out.
TEST(Light, BelowTheHorizonMeansNoLight) {
    auto lights = someLights();
    const MeshLight::Triangle triangle{Vec3(3, 4, 9), Vec3(5, 4, 9), Vec3(4, 6, 8)};
    lights.push_back(
        std::make_unique<MeshLight>(std::vector{triangle}, MeshLight::Emission{{}, true}));
    Rng rng(8);
    const auto direction = [&] {
        const Vec3 d = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) - 0.5f;
        return glm::normalize(d);
    };
    for (std::size_t k = 0; k < lights.size(); ++k) {
        int below = 0;
        for (int i = 0; i < 400; ++i) {
            const Vec3 from = direction() * (60.0f * rng.uniform()), normal = direction();
            if (!lights[k]->isBelow(from, normal)) continue;
            ++below;
            for (std::uint32_t s = 0; s < 32; ++s) {
                const LightSample sample = lights[k]->sample(from, Sampler(1, s).next2D());
                if (!(sample.pdf > 0)) continue;
                ASSERT_LT(glm::dot(sample.direction, normal), 1e-5f) << k;
            }
        }
        EXPECT_GT(below, lights[k]->isUniform() ? -1 : 120) << k;
    }
}

TEST(Light, IsSeenWithinItsBounds) {
    for (const auto& light : someLights()) {
        const Bounds box = light->visibleBounds();
        if (light->isDelta() || light->isInfinite()) {
            EXPECT_TRUE(box.isEmpty());
            continue;
        }
        for (std::uint32_t s = 0; s < 200; ++s) {
            const Vec3 from(1, -20, 3);
            const LightSample sample = light->sample(from, Sampler(2, s).next2D());
            EXPECT_LT(box.distanceSquared(from + sample.direction * sample.distance), 1e-6f);
        }
        EXPECT_LT(box.diagonal(), 20);
    }
}

}  // namespace
}  // namespace sss
