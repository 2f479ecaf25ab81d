// The space of pass 1: the same to the bit however bodies, lights and neighbours move together.
#include "sss/base/rng.h"
#include "sss/scene/light_motion.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

#include <cstring>

namespace sss {
namespace {

using testing::measured;
using testing::SceneMaker;

RigidTransform someMotion(Rng& rng) {
    const DVec3 axis = glm::normalize(DVec3(rng.uniform(), rng.uniform(), rng.uniform()) + 0.1);
    const DMat4 turn = glm::rotate(DMat4(1.0), 6.0 * rng.uniformDouble(), axis);
    return {DMat3(turn), DVec3(rng.uniform(), -rng.uniform(), rng.uniform()) * 70.0};
}

SceneMaker someScene() {
    SceneMaker maker;
    maker.object(BoxShape{DVec3(5, 7, 9)}, maker.material(measured("Marble")),
                 glm::scale(testing::turned(30, {1, 2, 3}), DVec3(1, 1.3, 0.7)));
    maker.object(BoxShape{DVec3(2)}, maker.material(LambertianMaterial{}),
                 testing::moved({9, 3, 1}));
    maker.light(RectangleLight{{30, 20, 10}, {0, 1, 2}, {0, 1, 0}, 4, 5, Rgb(3)});
    maker.light(SpotLight{{3, 50, 1}, {1, 1, 1}, Rgb(9), 30, 5});
    maker.light(DirectionalLight{glm::normalize(DVec3(1, -2, 3)), Rgb(1)});
    maker.light(PointLight{{5, 5, 50}, Rgb(7)});
    maker.light(SphereLight{{-9, 8, 7}, 2, Rgb(2)});
    maker.light(EnvironmentLight{Rgb(0.1f), {}, 0});
    return maker;
}

Scene movedScene(Scene scene, const RigidTransform& motion) {
    DMat4 matrix(motion.rotation);
    matrix[3] = {motion.translation, 1.0};
    for (ObjectSettings& object : scene.objects) object.transform.emplace_back(matrix);
    for (LightSettings& light : scene.lights) light = movedLight(light, motion);
    return scene;
}

template <typename T>
bool sameBits(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

struct LightBits {
    const LightSettings& other;
    bool operator()(const PointLight& l) const {
        return l.position == std::get<PointLight>(other).position;
    }
    bool operator()(const SpotLight& l) const {
        const auto& o = std::get<SpotLight>(other);
        return l.position == o.position && l.lookAt == o.lookAt;
    }
    bool operator()(const DirectionalLight& l) const {
        return l.direction == std::get<DirectionalLight>(other).direction;
    }
    bool operator()(const RectangleLight& l) const {
        const auto& o = std::get<RectangleLight>(other);
        return l.centre == o.centre && l.lookAt == o.lookAt && l.up == o.up;
    }
    bool operator()(const SphereLight& l) const {
        return l.centre == std::get<SphereLight>(other).centre;
    }
    bool operator()(const EnvironmentLight&) const { return true; }
};

TEST(LightSpace, IsTheSameToTheBitHoweverAllMovesTogether) {
    const SceneMaker maker = someScene();
    const World still = maker.world();
    SilentReporter silent;
    Rng rng(3);
    for (int i = 0; i < 20; ++i) {
        const World moved(movedScene(maker.scene, someMotion(rng)), silent);
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_TRUE(sameBits(moved.lightFromObject(k), still.lightFromObject(k))) << i;
        for (std::size_t k = 0; k < maker.scene.lights.size(); ++k)
            EXPECT_TRUE(
                std::visit(LightBits{still.lightInLightSpace(k)}, moved.lightInLightSpace(k)))
                << i << " light " << k;
    }
    const World moved(movedScene(maker.scene, someMotion(rng)), silent);
    const auto a = still.inLightSpace(), b = moved.inLightSpace();
    EXPECT_TRUE(sameBits(a->originMm(), b->originMm()));
    for (std::size_t k = 0; k < 2; ++k) {
        const auto p = a->geometry(k).positions, q = b->geometry(k).positions;
        ASSERT_EQ(p.size(), q.size());
        EXPECT_TRUE(std::equal(p.begin(), p.end(), q.begin()));
    }
    // One body alone is another matter: then its surroundings move around it.
    Scene scene = maker.scene;
    scene.objects[0].transform.emplace_back(testing::turned(5, {0, 1, 0}));
    const World other(scene, silent);
    EXPECT_FALSE(sameBits(other.lightFromObject(1), still.lightFromObject(1)));
}

TEST(LightSpace, KeepsTheScenesDistances) {
    const World world = someScene().world();
    const auto light = world.inLightSpace();
    const auto& lamp = std::get<RectangleLight>(world.scene().lights[0]);
    const auto& seen = std::get<RectangleLight>(light->scene().lights[0]);
    const auto corner = [](const World& w) {
        return DVec3(w.geometry(1).positions[7]) + w.originMm();
    };
    EXPECT_NEAR(glm::distance(lamp.centre, corner(world)),
                glm::distance(seen.centre, corner(*light)), 1e-5);
}

TEST(LightSpace, DoesNotTurnUnderAnEnvironmentWithADirection) {
    SceneMaker maker = someScene();
    const World even = maker.world();
    maker.scene.lights.back() = EnvironmentLight{Rgb(1), "sky.exr", 0};
    EXPECT_TRUE(hasDirection(std::get<EnvironmentLight>(maker.scene.lights.back())));
    EXPECT_NE(even.lightFromScene().rotation, DMat3(1.0));
}

}  // namespace
}  // namespace sss
