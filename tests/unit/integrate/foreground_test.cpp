#include "sss/integrate/foreground.h"

#include "sss/integrate/light_sampling.h"
#include "unit/integrate/pass_maker.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::SceneMaker;

// A ball in the middle and a lamp in a corner of the picture, in even light.
SceneMaker ballAndLamp() {
    SceneMaker maker;
    maker.object(SphereShape{10}, maker.material(LambertianMaterial{}));
    maker.light(EnvironmentLight{Rgb(0.25f), {}, 0});
    maker.light(RectangleLight{{20, 20, 0}, {20, 20, 10}, {0, 1, 0}, 4, 4, Rgb(5), false});
    maker.scene.camera.position = {0, 0, 100};
    maker.scene.camera.fovDegrees = 28;
    maker.scene.film.width = maker.scene.film.height = 64;
    return maker;
}

TEST(Foreground, LeavesOutOnlyPixelsOfEvenBackground) {
    const SceneMaker maker = ballAndLamp();
    const World world = maker.world();
    const Foreground foreground(world, 0.5f);
    EXPECT_EQ(foreground.background(), Rgb(0.25f));
    int left = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            if (foreground.mayShow(x, y)) continue;
            ++left;
            for (int s = 0; s < 9; ++s) {
                const Vec2 within(static_cast<float>(s % 3) / 2, static_cast<float>(s / 3) / 2);
                const Vec2 pixel = Vec2(static_cast<float>(x), static_cast<float>(y)) + within;
                const Ray ray = world.camera().ray(pixel, Vec2(0.5f));
                ASSERT_FALSE(world.rays().occluded(ray)) << x << ' ' << y;
                const float infinity = std::numeric_limits<float>::infinity();
                ASSERT_EQ(radianceOfLights(world, ray, infinity, {}), Rgb(0.25f)) << x << ' ' << y;
            }
        }
    // The ball covers an eighth of the picture (its box a fifth), the lamp a hundredth.
    EXPECT_GT(left, 64 * 64 * 83 / 100);
    EXPECT_TRUE(foreground.mayShow(32, 32));
}

// A floor that reaches behind the camera cannot be projected as a whole.
TEST(Foreground, IsEverywhereAroundWhatIsNotWhollyInFront) {
    SceneMaker maker = ballAndLamp();
    maker.object(BoxShape{{1000, 1, 1000}}, 0, testing::moved({0, -50, 0}));
    const World world = maker.world();
    EXPECT_TRUE(Foreground(world, 0.5f).mayShow(0, 0));
}

// Pictures larger than the grid of cells: each cell stands for several pixels.
TEST(Foreground, LeavesOutMostOfALargePicture) {
    SceneMaker maker = ballAndLamp();
    maker.scene.film.width = 1500;
    maker.scene.film.height = 1031;
    const World world = maker.world();
    const Foreground foreground(world, 0.5f);
    int left = 0;
    for (int y = 0; y < 1031; y += 3)
        for (int x = 0; x < 1500; x += 5) {
            if (foreground.mayShow(x, y)) continue;
            ++left;
            const Vec2 pixel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            ASSERT_FALSE(world.rays().occluded(world.camera().ray(pixel, Vec2(0.5f))));
        }
    EXPECT_GT(left, 300 * 343 * 83 / 100);
}

TEST(Foreground, IsEverywhereThroughALens) {
    SceneMaker maker = ballAndLamp();
    maker.scene.camera.apertureRadiusMm = 2;
    const World world = maker.world();
    EXPECT_TRUE(Foreground(world, 0.5f).mayShow(0, 63));
}

// A lamp in front of a black wall, half of it beyond the left edge of the picture, and then all of
// it: a lamp a pixel out of sight still reaches pixels whose filter is wider than that.
TEST(Foreground, LampsShowBeforeSurfacesAtTheEdgeOfThePicture) {
    SceneMaker maker;
    LambertianMaterial black;
    black.reflectance = Rgb(0);
    maker.object(BoxShape{{200, 200, 1}}, maker.material(black));
    maker.scene.camera.position = {0, 0, 100};
    maker.scene.film.width = maker.scene.film.height = 32;
    maker.scene.film.samples = 64;
    maker.scene.film.filter = FilterKind::Box;
    const Camera camera = maker.world().camera();
    // Where the edge is, half way to the wall.
    const double edge = camera.ray(Vec2(0, 16), Vec2(0.5f)).direction.x /
                        -camera.ray(Vec2(0, 16), Vec2(0.5f)).direction.z * 50;
    const double pixel = -edge / 16;
    const auto brightestAtLeft = [&](double right, double radius) {
        SceneMaker lit = maker;
        lit.light(RectangleLight{
            {right - 1, 0, 50}, {right - 1, 0, 60}, {0, 1, 0}, 2, 60, Rgb(5), false});
        lit.scene.film.filterRadiusPixels = radius;
        return testing::value(testing::picture(lit.scene), "", 0, 16, 1);
    };
    EXPECT_NEAR(brightestAtLeft(edge + pixel, 0.5), 5, 1e-3);
    EXPECT_EQ(brightestAtLeft(edge - 0.1 * pixel, 0.5), 0);
    EXPECT_GT(brightestAtLeft(edge - pixel, 2.0), 0);
}

}  // namespace
}  // namespace sss
