#include "unit/scene/scene_text.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

/// Where the step takes a point.
DVec3 applied(const TransformStep& step, const DVec3& p) {
    return DVec3(std::get<DMat4>(step) * glm::dvec4(p, 1));
}

TEST(ObjectReader, ReadsEveryTransformStepInOrder) {
    const Scene scene = read({.units = "0.01", .objects = R"({"shape": "sphere", "radius": 1,
        "material": "milk", "transform": [
          {"translate": [1, 2, 3]},
          {"rotate": {"axis": [0, 0, 5], "degrees": 90}},
          {"scale": [2, 3, -4]},
          {"scale": 0.5},
          {"matrix": [0, -1, 0, 7,  1, 0, 0, 8,  0, 0, 1, 9,  0, 0, 0, 1]},
          {"fit": {"height": 5, "centre": [1, 2, 3]}},
          {"fit": {"height": 6}}]})"});
    const auto& steps = scene.objects.at(0).transform;
    ASSERT_EQ(steps.size(), 7u);
    const DVec3 p{1, 2, 3};
    const auto near = [](const DVec3& a, const DVec3& b) { return glm::length(a - b) < 1e-12; };
    EXPECT_TRUE(near(applied(steps[0], p), {11, 22, 33}));
    EXPECT_TRUE(near(applied(steps[1], p), {-2, 1, 3}));
    EXPECT_TRUE(near(applied(steps[2], p), {2, 6, -12}));
    EXPECT_TRUE(near(applied(steps[3], p), {0.5, 1, 1.5}));
    EXPECT_TRUE(near(applied(steps[4], p), {68, 81, 93}));
    EXPECT_EQ(std::get<FitStep>(steps[5]).heightMm, 50);
    EXPECT_EQ(std::get<FitStep>(steps[5]).centre, DVec3(10, 20, 30));
    EXPECT_EQ(std::get<FitStep>(steps[6]).centre, DVec3(0));
}

TEST(ObjectReader, ResolvesMeshPathsAndNamesObjects) {
    const Scene scene = read({.objects = R"(
        {"mesh": "../meshes/cow.ply", "material": "milk"},
        {"mesh": "/else/cow.obj", "material": "milk"},
        {"name": "cow-3", "shape": "sphere", "radius": 1, "material": "milk"},
        {"mesh": "cow.stl", "material": "milk"},
        {"shape": "sphere", "radius": 1, "material": "milk"})"});
    EXPECT_EQ(std::get<MeshFileShape>(scene.objects[0].shape).path, "/scenes/meshes/cow.ply");
    EXPECT_EQ(std::get<MeshFileShape>(scene.objects[1].shape).path, "/else/cow.obj");
    EXPECT_EQ(scene.objects[0].name, "cow");
    EXPECT_EQ(scene.objects[1].name, "cow-2");
    EXPECT_EQ(scene.objects[2].name, "cow-3");
    EXPECT_EQ(scene.objects[3].name, "cow-4");  // cow-3 is taken
    EXPECT_EQ(scene.objects[4].name, "sphere");
}

}  // namespace
}  // namespace sss
