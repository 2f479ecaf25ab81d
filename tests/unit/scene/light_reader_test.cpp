#include "unit/scene/scene_text.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

TEST(LightReader, ReadsEveryLight) {
    const Scene scene = read({.units = "0.01", .rest = R"(, "lights": [
        {"type": "point", "position": [1, 2, 3], "intensity": [4, 5, 6]},
        {"type": "spot", "position": [0, 9, 0], "lookAt": [1, 0, 0], "intensity": 7,
         "coneDegrees": 20, "penumbraDegrees": 4},
        {"type": "spot", "position": [0, 9, 0], "intensity": 7, "coneDegrees": 3},
        {"type": "directional", "direction": [0, -3, 4], "irradiance": 8},
        {"type": "rectangle", "centre": [0, 5, 0], "lookAt": [0, 1, 0], "width": 2, "height": 3,
         "radiance": 9, "twoSided": true},
        {"type": "sphere", "centre": [1, 1, 1], "radius": 0.5, "radiance": 10},
        {"type": "environment", "map": "sky.exr", "radiance": [1, 2, 3], "rotationDegrees": 90}])"});
    ASSERT_EQ(scene.lights.size(), 7u);
    const auto& bulb = std::get<PointLight>(scene.lights[0]);
    EXPECT_EQ(bulb.position, DVec3(10, 20, 30));
    EXPECT_EQ(bulb.intensity, Rgb(4, 5, 6));  // W/sr whatever the unit
    const auto& spot = std::get<SpotLight>(scene.lights[1]);
    EXPECT_EQ(spot.position, DVec3(0, 90, 0));
    EXPECT_EQ(spot.lookAt, DVec3(10, 0, 0));
    EXPECT_EQ(spot.intensity, Rgb(7));
    EXPECT_EQ(spot.coneDegrees, 20);
    EXPECT_EQ(spot.penumbraDegrees, 4);
    EXPECT_EQ(std::get<SpotLight>(scene.lights[2]).penumbraDegrees, 3);  // no wider than the cone
    const auto& sun = std::get<DirectionalLight>(scene.lights[3]);
    EXPECT_LT(glm::length(sun.direction - DVec3(0, -0.6, 0.8)), 1e-15);
    EXPECT_EQ(sun.irradiance, Rgb(8));
    const auto& lamp = std::get<RectangleLight>(scene.lights[4]);
    EXPECT_EQ(lamp.centre, DVec3(0, 50, 0));
    EXPECT_EQ(lamp.lookAt, DVec3(0, 10, 0));
    EXPECT_EQ(lamp.up, DVec3(0, 0, 1));  // it faces straight down
    EXPECT_EQ(lamp.widthMm, 20);
    EXPECT_EQ(lamp.heightMm, 30);
    EXPECT_EQ(lamp.radiance, Rgb(9));
    EXPECT_TRUE(lamp.twoSided);
    const auto& globe = std::get<SphereLight>(scene.lights[5]);
    EXPECT_EQ(globe.centre, DVec3(10));
    EXPECT_EQ(globe.radiusMm, 5);
    EXPECT_EQ(globe.radiance, Rgb(10));
    const auto& sky = std::get<EnvironmentLight>(scene.lights[6]);
    EXPECT_EQ(sky.map, "/scenes/here/sky.exr");
    EXPECT_EQ(sky.radiance, Rgb(1, 2, 3));
    EXPECT_EQ(sky.rotationDegrees, 90);
}

}  // namespace
}  // namespace sss
