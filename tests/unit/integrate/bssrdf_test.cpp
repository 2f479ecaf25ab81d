#include "sss/integrate/bssrdf_exitance.h"
#include "unit/integrate/batches.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::Estimate;
using testing::SceneMaker;

constexpr const char* kProfiles[] = {"dipole", "better_dipole", "normalized_diffusion"};

TranslucentMaterial coloured(const char* profile) {
    TranslucentMaterial material = testing::grey(0, 0, 1.4);
    material.medium.sigmaA = {0.005, 0.05, 0.4};
    material.medium.sigmaS = {1, 1.5, 2};
    material.profile = profile;
    material.singleScattering = false;  // whose share takes a while to compute
    return material;
}

// A lamp from one side, a faint sky, a floor that throws light back, and a sun that casts an edge.
void lightUp(SceneMaker& maker) {
    RectangleLight lamp;
    lamp.centre = {-12, 9, 4};
    lamp.lookAt = {0, 0, 0};
    lamp.up = {0, 1, 0};
    lamp.widthMm = lamp.heightMm = 6;
    lamp.radiance = {4, 5, 6};
    maker.light(lamp);
    maker.light(EnvironmentLight{Rgb(0.3f), {}, 0});
    maker.light(DirectionalLight{{0.3, -1, -0.4}, Rgb(0.5f)});
    maker.object(RectangleShape{60, 60}, maker.material(LambertianMaterial{{0.8f, 0.6f, 0.4f}}),
                 testing::moved({0, -4, 0}) * testing::turned(-90, {1, 0, 0}));
    maker.scene.quality.bounces = 2;
    maker.scene.quality.tolerance = 0.01;
}

// The sum over the points of pass 1 is what the samples tend to.
void expectTheCachesExitance(const SceneMaker& maker) {
    const World world = maker.world();
    const auto optics = makeBodyOptics(world);
    const testing::MadeClouds made(world, optics);
    const BodyField field(world.bodies()[0], *optics[0], made.clouds[0].view(), 0.01);
    const BssrdfExitance source(world, optics);
    const auto faces = static_cast<FaceIndex>(world.bodies()[0].mesh.faceCount());
    // A largest value that the tolerance refers to where there is hardly any light.
    Rgb brightest(0);
    for (FaceIndex f = 0; f < faces; f += 1 + faces / 64)
        brightest = glm::max(brightest, field.exitance(f, {0.3f, 0.4f}));
    for (int k = 0; k < 6; ++k) {
        const auto face = static_cast<FaceIndex>((2 * k + 1) * faces / 12);
        const Vec2 barycentrics(0.3f, 0.4f);
        const SurfaceHit hit = world.surfaceOf(0, face, barycentrics);
        PathCounts counts;
        const Estimate e = testing::batchEstimate(
            31, 256, [&](Sampler& sampler) { return DRgb(source.exitance(hit, sampler, counts)); });
        const DRgb cached(field.exitance(face, barycentrics));
        for (int c = 0; c < 3; ++c) {
            const double tolerance = 0.01 * cached[c] + 0.002 * static_cast<double>(brightest[c]);
            EXPECT_NEAR(e.mean[c], cached[c], 3.5 * e.error[c] + tolerance)
                << "place " << k << " channel " << c;
            EXPECT_LT(e.error[c], 0.03 * static_cast<double>(brightest[c]));
        }
    }
}

TEST(Bssrdf, SphereAsByTheCache) {
    for (const char* profile : kProfiles) {
        SCOPED_TRACE(profile);
        SceneMaker maker;
        maker.object(SphereShape{3}, maker.material(coloured(profile)));
        lightUp(maker);
        expectTheCachesExitance(maker);
    }
}

TEST(Bssrdf, ThinSlabAsByTheCache) {
    for (const char* profile : kProfiles) {
        SCOPED_TRACE(profile);
        SceneMaker maker;
        maker.object(BoxShape{{8, 0.5, 8}}, maker.material(coloured(profile)));
        lightUp(maker);
        expectTheCachesExitance(maker);
    }
}

TEST(Bssrdf, BoxAsByTheCache) {
    for (const char* profile : kProfiles) {
        SCOPED_TRACE(profile);
        SceneMaker maker;
        maker.object(BoxShape{DVec3(4)}, maker.material(coloured(profile)),
                     testing::turned(33, {1, 2, 0}));
        lightUp(maker);
        expectTheCachesExitance(maker);
    }
}

}  // namespace
}  // namespace sss
