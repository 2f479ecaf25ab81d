// What pass 1 itself is wrong by: the points that a tolerance asks for, and their light samples,
// against a cloud 16 times as dense whose irradiance has converged. Errors are RMS over places of
// the surface, relative to the mean exitance, in the worst channel.
//
// The budget: `tolerance` bounds what the hierarchy and interpolation add to the sum over the
// points. The points may add half of it (under even light the rule of spacing.h asks for 0.15 of
// it; the lamp's edges cost the rest), the noise of the light samples half, so that both together,
// being independent, stay within 0.71 of it.
#include "sss/cloud/diffusion_sum.h"
#include "sss/cloud/surface_strata.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sss {
namespace {

using testing::measured;
using testing::SceneMaker;

constexpr double kTolerance = 0.025;  // of scenes/bunny/bunny.json
constexpr double kPointShare = 0.5, kLightShare = 0.5, kBothShare = 0.71;
constexpr int kConverged = 16;  // light samples a point of the dense cloud

// A ball under the lamp and the sky of the benchmark, nearer.
SceneMaker ball(std::string_view medium, double radiusPerMfp) {
    SceneMaker maker;
    TranslucentMaterial material = measured(medium);
    material.surfaceReflection = material.singleScattering = false;
    const double radius = radiusPerMfp * material.medium.smallestMeanFreePathMm();
    maker.object(SphereShape{radius}, maker.material(material));
    maker.light(RectangleLight{.centre = DVec3(-6, 3, 2) * radius,
                               .widthMm = 5 * radius,
                               .heightMm = 5 * radius,
                               .radiance = Rgb(10)});
    EnvironmentLight sky;
    sky.radiance = Rgb(0.05f);
    maker.light(sky);
    maker.scene.quality.tolerance = kTolerance;
    maker.scene.quality.bounces = 0;
    return maker;
}

// Exitance at places of the body by a pass 1 of its own: the sum over all points.
struct PassOne {
    double spacingMm;
    int samples;
    std::vector<DRgb> exitance;

    PassOne(const Scene& scene, std::size_t receivers) {
        SilentReporter silent;
        const World world(scene, silent);
        const auto optics = makeBodyOptics(world);
        const testing::MadeClouds made(world, optics);
        const BodyCloud& cloud = made.clouds[0];
        spacingMm = cloud.spacingMm;
        samples = made.reports[0].irradianceSamples;
        const TriangleMesh& mesh = world.bodies()[0].mesh;
        const KernelTable table(optics[0]->profilePointers(), mesh.bounds().diagonal(),
                                spacingMm / std::sqrt(kPi));
        const BodyCloud::View view = cloud.view();
        const DiffusionSum sum(view.cloud, view.nodes, table);
        for (const Vec3& place : makeStrata(mesh, receivers, 5).positions)
            exitance.push_back(sum.bruteForce(place));
    }
};

double rmsOfMean(const PassOne& a, const PassOne& b) {
    DRgb squares{0}, sum{0};
    for (std::size_t i = 0; i < b.exitance.size(); ++i) {
        const DRgb miss = a.exitance[i] - b.exitance[i];
        squares += miss * miss;
        sum += b.exitance[i];
    }
    return maxComponent(glm::sqrt(squares * static_cast<double>(b.exitance.size())) / sum);
}

void expectWithinBudget(std::string_view medium, double radiusPerMfp) {
    SCOPED_TRACE(medium);
    constexpr std::size_t kReceivers = 256;
    Scene scene = ball(medium, radiusPerMfp).scene;
    const PassOne asked(scene, kReceivers);
    scene.quality.irradianceSamples = 16 * kConverged;
    const PassOne wellLit(scene, kReceivers);
    scene.quality.spacingMm = asked.spacingMm / 4;
    scene.quality.irradianceSamples = kConverged;
    const PassOne reference(scene, kReceivers);
    EXPECT_LE(asked.samples, kConverged);
    const double points = rmsOfMean(wellLit, reference), light = rmsOfMean(asked, wellLit),
                 both = rmsOfMean(asked, reference);
    ::testing::Test::RecordProperty("points", std::to_string(points));
    ::testing::Test::RecordProperty("light", std::to_string(light));
    EXPECT_LT(points, kPointShare * kTolerance);
    EXPECT_LT(light, kLightShare * kTolerance);
    EXPECT_LT(both, kBothShare * kTolerance);
    // The budget is used, not far below: points and rays beyond it would be wasted.
    EXPECT_GT(both, 0.05 * kTolerance);
}

TEST(ErrorBudget, PointsAndLightOfABrightMedium) { expectWithinBudget("Marble", 4); }
TEST(ErrorBudget, PointsAndLightOfAnAbsorbingMedium) { expectWithinBudget("Ketchup", 3); }

}  // namespace
}  // namespace sss
