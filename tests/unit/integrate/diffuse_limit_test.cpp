// Bodies in their diffuse limit: who they are, and that one sees no difference.
#include "sss/integrate/diffuse_limit.h"

#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::grey;
using testing::MadeClouds;
using testing::measured;
using testing::SceneMaker;
using testing::value;

TEST(MeanShift, IsTheFirstMomentOfTheProfile) {
    for (const char* kind : {"dipole", "normalized_diffusion", "photon_beam"}) {
        TranslucentMaterial material = grey(2, 3, 1.3);
        material.profile = kind;
        const BodyOptics optics(material);
        const Profile& profile = *optics.profiles[0];
        // By the profile itself, over log r; the tests of medium/ hold it against its tail().
        double moment = 0, near = 0;
        constexpr int kSteps = 4000;
        const double lo = std::log(1e-7), hi = std::log(200.0), reach = 0.3;
        for (int i = 0; i < kSteps; ++i) {
            const double r = std::exp(lo + (i + 0.5) * (hi - lo) / kSteps);
            const double share =
                2 * kPi * r * r * profile.reflectance(r) * (hi - lo) / kSteps / profile.total();
            moment += r * share;
            near += std::min(r, reach) * share;
        }
        EXPECT_NEAR(meanShiftMm(profile, 200) / moment, 1, 2e-3) << kind;
        EXPECT_NEAR(meanShiftMm(profile, reach) / near, 1, 2e-3) << kind;
    }
    EXPECT_EQ(meanShiftMm(*BodyOptics(grey(1, 0, 1.3)).profiles[0], 10), 0);
}

TEST(LocalThickness, IsThatOfTheThinnestPart) {
    SceneMaker maker;
    const int material = maker.material(measured("Marble"));
    maker.object(BoxShape{{14, 5, 9}}, material);
    maker.object(SphereShape{3}, material, testing::moved({40, 0, 0}));
    // One body of two blocks with a gap between.
    maker.object(BoxShape{DVec3(4)}, material, testing::moved({80, 0, 0})).group = "pair";
    maker.object(BoxShape{DVec3(4)}, material, testing::moved({80, 4.25, 0})).group = "pair";
    const World world = maker.world();
    ASSERT_EQ(world.bodies().size(), 3u);
    EXPECT_NEAR(localThicknessMm(world, 0), 5, 1e-3);
    EXPECT_NEAR(localThicknessMm(world, 1), 6, 0.05);  // tessellated
    EXPECT_NEAR(localThicknessMm(world, 2), 0.25, 1e-3);
}

// A block of a medium so absorbing that light leaves near where it entered, seen from so far that
// it is a few pixels wide; half in the shade of a screen.
SceneMaker farBlock() {
    SceneMaker maker;
    TranslucentMaterial dense = grey(6, 6, 1.3);
    dense.medium.sigmaS.y = 4;
    maker.object(BoxShape{DVec3(6)}, maker.material(dense));
    maker.object(RectangleShape{40, 40}, maker.material(LambertianMaterial{}),
                 testing::moved({20.7, 30, 0}) * testing::turned(-90, {1, 0, 0}));
    maker.light(DirectionalLight{{0, -1, -0.2}, Rgb(3)});
    maker.light(EnvironmentLight{Rgb(0.2f), {}, 0});
    Scene& scene = maker.scene;
    scene.camera.position = {0, 90, 130};
    scene.camera.lookAt = {0, 0, 0};
    scene.camera.fovDegrees = 6;
    scene.film.width = scene.film.height = 10;
    scene.film.samples = 128;
    scene.quality.tolerance = 0.1;
    scene.quality.bounces = 1;
    return maker;
}

bool isInLimit(const Scene& scene, std::size_t body = 0) {
    SilentReporter silent;
    const World world(scene, silent);
    const auto optics = makeBodyOptics(world);
    findDiffuseLimits(world, optics, silent);
    return optics[body]->inDiffuseLimit;
}

TEST(DiffuseLimit, LooksLikeTheFullPass) {
    const Scene scene = farBlock().scene;
    SilentReporter silent;
    const World world(scene, silent);
    std::vector<RenderResult> results;
    for (const bool isLimited : {false, true}) {
        const auto optics = makeBodyOptics(world);
        if (isLimited) findDiffuseLimits(world, optics, silent);
        ASSERT_EQ(optics[0]->inDiffuseLimit, isLimited);
        const MadeClouds made(world, optics);
        EXPECT_EQ(made.clouds[0].points.empty(), isLimited);
        results.push_back(testing::resultFrom(
            world, optics, [&](std::size_t b) { return made.clouds[b].view(); }));
    }
    const LayeredImage &full = results[0].image, &limit = results[1].image;
    double brightest = 0, difference[2] = {0, 0}, sum[2] = {0, 0};
    int seen = 0, dim = 0;
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 10; ++x)
            brightest = std::max(brightest, value(full, "diffusion", x, y, 0));
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 10; ++x) {
            for (const int c : {0, 1}) {
                const double a = value(full, "diffusion", x, y, c),
                             b = value(limit, "diffusion", x, y, c);
                EXPECT_NEAR(b, a, scene.quality.tolerance * brightest) << x << ' ' << y << ' ' << c;
                difference[c] += b - a;
                sum[c] += a;
            }
            const double red = value(full, "diffusion", x, y, 0);
            seen += red > 0 ? 1 : 0;
            dim += red > 0 && red < 0.3 * brightest ? 1 : 0;
        }
    EXPECT_GT(seen, 20);
    EXPECT_GT(dim, 4);  // the shade is in the picture
    for (const int c : {0, 1}) EXPECT_NEAR(difference[c] / sum[c], 0, scene.quality.tolerance / 4);
    EXPECT_GT(results[1].counts.diffusionLookups, 0u);
}

// The rule is the header's: on either side of each of its bounds.
TEST(DiffuseLimit, IsForWhatIsFarAndThickOnly) {
    SceneMaker maker = farBlock();
    Scene& scene = maker.scene;
    const auto rule = [&](double shiftShare) {
        const World world = maker.world();
        const auto optics = makeBodyOptics(world);
        double shift = 0;
        for (const auto& profile : optics[0]->profiles)
            shift = std::max(shift, meanShiftMm(*profile, 6 * std::sqrt(3.0)));
        // The nearest corner, straight towards the camera; corners of the film see a bit less.
        const DVec3 view = glm::normalize(scene.camera.lookAt - scene.camera.position);
        const double depth =
            glm::length(scene.camera.position) - 3 * (std::abs(view.y) + std::abs(view.z));
        const double tangent = std::tan(glm::radians(3.0));
        const double pixel = depth * 2 * tangent / 10 / std::sqrt(1 + 2 * tangent * tangent);
        return shiftShare * shift / pixel;
    };
    const double tolerance = rule(1);
    EXPECT_LT(tolerance, 0.1);
    scene.quality.tolerance = 1.01 * tolerance;
    EXPECT_TRUE(isInLimit(scene));
    scene.quality.tolerance = 0.99 * tolerance;
    EXPECT_FALSE(isInLimit(scene));
    scene.quality.tolerance = 0.1;
    scene.film.filterRadiusPixels = 0.2;  // finer than a pixel
    EXPECT_FALSE(isInLimit(scene));
    scene.film.filterRadiusPixels = farBlock().scene.film.filterRadiusPixels;
    EXPECT_TRUE(isInLimit(scene));
    scene.objects[0].shape = BoxShape{{6, 0.4, 6}};  // light comes through
    EXPECT_FALSE(isInLimit(scene));
    scene.objects[0].shape = BoxShape{{6, 6, 6}};
    scene.camera.position = {0, 2, 2};  // inside its bounds
    EXPECT_FALSE(isInLimit(scene));
}

TEST(DiffuseLimit, IsFarFromUsualScenes) {
    for (const MeasuredMedium& medium : measuredMedia()) {
        SceneMaker maker;
        maker.object(BoxShape{DVec3(30)}, maker.material(measured(medium.name)));
        maker.light(EnvironmentLight{Rgb(1), {}, 0});
        maker.scene.camera.position = {0, 0, 130};
        maker.scene.camera.fovDegrees = 28;
        maker.scene.film.width = maker.scene.film.height = 64;
        maker.scene.quality.tolerance = 0.01;
        EXPECT_FALSE(isInLimit(maker.scene)) << medium.name;
    }
}

// A body that sends nothing back wants no points either.
TEST(DiffuseLimit, BlackNeedsNoPoints) {
    SceneMaker maker;
    maker.object(SphereShape{5}, maker.material(grey(2, 0, 1.3)));
    maker.light(EnvironmentLight{Rgb(1), {}, 0});
    maker.scene.camera.position = {0, 0, 30};
    EXPECT_TRUE(isInLimit(maker.scene));
}

}  // namespace
}  // namespace sss
