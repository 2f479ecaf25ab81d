#include "sss/integrate/bssrdf_exitance.h"
#include "sss/integrate/integrator_table.h"
#include "unit/integrate/batches.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

#include <filesystem>

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

// A lamp from one side and a faint sky. No sharp edges of light, which pass 1 blurs over its cells.
void shineUpon(SceneMaker& maker) {
    RectangleLight lamp;
    lamp.centre = {-12, 9, 4};
    lamp.lookAt = {0, 0, 0};
    lamp.up = {0, 1, 0};
    lamp.widthMm = lamp.heightMm = 6;
    lamp.radiance = {4, 5, 6};
    maker.light(lamp);
    maker.light(EnvironmentLight{Rgb(0.3f), {}, 0});
}

// The same, and a floor that throws light back.
void lightUp(SceneMaker& maker) {
    shineUpon(maker);
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
        const Estimate e = testing::batchEstimate(31, 256, [&](Sampler& sampler) {
            return DRgb(source.exitance(hit, hit.geometricNormal, sampler, counts));
        });
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

// Every profile on one shape, in the mean over places all over it, by channel. Directly lit: that
// is the same whatever the profile, so that one pass 1 serves all three.
void expectTheCachesMean(SceneMaker maker, double spacingMm) {
    shineUpon(maker);
    maker.scene.quality.bounces = 0;
    maker.scene.quality.spacingMm = spacingMm;
    maker.scene.quality.irradianceSamples = 32;
    const World world = maker.world();
    const testing::MadeClouds made(world, makeBodyOptics(world));
    const auto faces = static_cast<FaceIndex>(world.bodies()[0].mesh.faceCount());
    constexpr FaceIndex kPlaces = 256;
    std::vector<SurfaceHit> places;
    for (FaceIndex k = 0; k < kPlaces; ++k) {
        Vec2 u = glm::fract(static_cast<float>(k) * Vec2(0.7548777f, 0.5698403f));
        if (u.x + u.y > 1) u = 1.0f - u;
        places.push_back(world.surfaceOf(0, (2 * k + 1) * faces / (2 * kPlaces), u));
    }
    for (const char* profile : {"dipole", "better_dipole", "normalized_diffusion"}) {
        SCOPED_TRACE(profile);
        const TranslucentMaterial material = coloured(profile);
        std::vector<std::unique_ptr<BodyOptics>> optics;
        optics.push_back(std::make_unique<BodyOptics>(material));
        const BodyField field(world.bodies()[0], *optics[0], made.clouds[0].view(), 0.01);
        DRgb cached(0);
        for (const SurfaceHit& hit : places)
            cached += DRgb(field.exitance(hit.bodyFace, hit.barycentrics)) / double{kPlaces};
        const BssrdfExitance source(world, optics);
        PathCounts counts;
        std::size_t next = 0;
        const Estimate e = testing::batchEstimate(31, 2 * kPlaces, [&](Sampler& sampler) {
            return DRgb(source.exitance(places[next++ % kPlaces], Vec3(0, 0, 1), sampler, counts));
        });
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(e.mean[c], cached[c], 3.5 * e.error[c] + 0.005 * cached[c])
                << "channel " << c << ": " << e.mean[c] / cached[c] - 1;
            EXPECT_LT(e.error[c], 0.015 * cached[c]) << "channel " << c;
        }
    }
}

TEST(Bssrdf, PlaneAsByTheCache) {
    SceneMaker maker;
    maker.object(RectangleShape{3, 2}, maker.material(coloured("dipole")),
                 testing::turned(-80, {1, 0, 0}));
    expectTheCachesMean(maker, 0.03);
}

TEST(Bssrdf, SphereAsByTheCache) {
    SceneMaker maker;
    maker.object(SphereShape{1}, maker.material(coloured("dipole")));
    expectTheCachesMean(maker, 0.03);
}

TEST(Bssrdf, ThinSlabAsByTheCache) {
    SceneMaker maker;
    maker.object(BoxShape{{3, 0.3, 3}}, maker.material(coloured("dipole")));
    expectTheCachesMean(maker, 0.03);
}

// Meshes that are not part of the sources.
void expectTheCachesMeanOn(const std::filesystem::path& mesh) {
    if (!std::filesystem::exists(mesh)) GTEST_SKIP() << mesh << " is not there";
    SceneMaker maker;
    maker.object(MeshFileShape{mesh}, maker.material(coloured("dipole"))).transform = {
        FitStep{2.5, DVec3(0)}};
    expectTheCachesMean(maker, 0.03);
}

TEST(Bssrdf, BunnyAsByTheCache) { expectTheCachesMeanOn("/usr/share/glmark2/models/bunny.obj"); }

TEST(Bssrdf, SpotAsByTheCache) {
    expectTheCachesMeanOn(std::filesystem::path(SSS_SOURCE_DIR) / "../shared/meshes/spot.obj");
}

// Corners, and faces that no axis is square to.
TEST(Bssrdf, TurnedBoxAsByTheCache) {
    expectTheCachesExitance(BoxShape{DVec3(1)}, "dipole", testing::turned(33, {1, 2, 0}));
}

// With single scattering. Another body, and the same one in a mirror, are seen at second hand as
// the cache shows them.
TEST(Bssrdf, ReflectionsAsByTheCache) {
    SceneMaker maker;
    const int mirror = maker.material(MetalMaterial{});
    TranslucentMaterial material = coloured("dipole");
    material.singleScattering = true;
    const int jelly = maker.material(material);
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
                return DRgb(sample.diffusion + sample.single + sample.surface);
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
