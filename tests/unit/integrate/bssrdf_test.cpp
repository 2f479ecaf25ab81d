#include "sss/integrate/bssrdf_exitance.h"
#include "sss/integrate/integrator_table.h"
#include "unit/integrate/batches.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::Estimate;
using testing::SceneMaker;

TranslucentMaterial coloured(const char* profile) {
    TranslucentMaterial material = testing::grey(0, 0, 1.4);
    material.medium.sigmaA = {0.005, 0.05, 0.3};
    material.medium.sigmaS = {1, 1.1, 1.2};
    material.profile = profile;
    material.singleScattering = false;  // whose share takes a while to compute
    return material;
}

// A lamp from one side, a faint sky, and a floor that throws light back. No sharp edges of light,
// which pass 1 blurs over its cells.
void lightUp(SceneMaker& maker) {
    RectangleLight lamp;
    lamp.centre = {-12, 9, 4};
    lamp.lookAt = {0, 0, 0};
    lamp.up = {0, 1, 0};
    lamp.widthMm = lamp.heightMm = 6;
    lamp.radiance = {4, 5, 6};
    maker.light(lamp);
    maker.light(EnvironmentLight{Rgb(0.3f), {}, 0});
    maker.object(RectangleShape{60, 60}, maker.material(LambertianMaterial{{0.8f, 0.6f, 0.4f}}),
                 testing::moved({0, -4, 0}) * testing::turned(-90, {1, 0, 0}));
    maker.scene.quality.bounces = 2;
    // Between points that lie at the default spacing singular profiles are off by some per cent.
    maker.scene.quality.tolerance = 0.001;
    maker.scene.quality.irradianceSamples = 32;
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
    for (int k = 0; k < 4; ++k) {
        const auto face = static_cast<FaceIndex>((2 * k + 1) * faces / 8);
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

void expectTheCachesExitance(const Shape& shape, const char* profile, const DMat4& placed) {
    SCOPED_TRACE(profile);
    SceneMaker maker;
    maker.object(shape, maker.material(coloured(profile)), placed);
    lightUp(maker);
    expectTheCachesExitance(maker);
}

TEST(Bssrdf, SphereAsByTheCache) {
    for (const char* profile : {"dipole", "better_dipole", "normalized_diffusion"})
        expectTheCachesExitance(SphereShape{1}, profile, DMat4(1));
}

TEST(Bssrdf, ThinSlabAsByTheCache) {
    for (const char* profile : {"dipole", "normalized_diffusion"})
        expectTheCachesExitance(BoxShape{{3, 0.3, 3}}, profile, DMat4(1));
}

TEST(Bssrdf, PlaneAsByTheCache) {
    expectTheCachesExitance(RectangleShape{3, 2}, "better_dipole", testing::turned(-80, {1, 0, 0}));
}

// Corners, and faces that no axis is square to.
TEST(Bssrdf, TurnedBoxAsByTheCache) {
    expectTheCachesExitance(BoxShape{DVec3(1)}, "dipole", testing::turned(33, {1, 2, 0}));
}

// Another body, and the same one in a mirror, are seen at second hand as the cache shows them.
TEST(Bssrdf, ReflectionsAsByTheCache) {
    SceneMaker maker;
    const int mirror = maker.material(MetalMaterial{});
    const int jelly = maker.material(coloured("dipole"));
    maker.object(SphereShape{1}, jelly, testing::moved({0, 0, 0}));
    maker.object(BoxShape{{0.5, 2, 2}}, jelly, testing::moved({1.6, 0, 0}));
    lightUp(maker);
    maker.object(RectangleShape{20, 20}, mirror, testing::moved({0, 0, -2}));
    const World world = maker.world();
    const auto optics = makeBodyOptics(world);
    const testing::MadeClouds made(world, optics);
    std::vector<std::unique_ptr<BodyField>> fields;
    for (std::size_t b = 0; b < 2; ++b)
        fields.push_back(std::make_unique<BodyField>(world.bodies()[b], *optics[b],
                                                     made.clouds[b].view(), 0.01));
    const IntegratorInput input{world, optics, fields};
    const auto cached = findIntegrator("cached")->make(input);
    const auto bssrdf = findIntegrator("bssrdf")->make({world, optics, {}});
    for (const Vec2& aim : {Vec2(0.3f, 0.5f), Vec2(1.2f, 0.7f)}) {
        Ray ray;
        ray.origin = {aim.x, aim.y, 9};
        ray.direction = {0, 0, -1};
        PathCounts counts;
        const auto seen = [&](const Integrator& integrator) {
            return testing::batchEstimate(9, 256, [&](Sampler& sampler) {
                const FilmSample sample = integrator.trace(ray, sampler, counts);
                return DRgb(sample.diffusion + sample.surface);
            });
        };
        const Estimate a = seen(*bssrdf), b = seen(*cached);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(a.mean[c], b.mean[c],
                        3.5 * std::hypot(a.error[c], b.error[c]) + 0.01 * b.mean[c]);
            EXPECT_LT(a.error[c], 0.03 * b.mean[c]);
        }
    }
}

}  // namespace
}  // namespace sss
