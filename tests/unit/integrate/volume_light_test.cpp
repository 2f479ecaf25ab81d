#include "sss/base/error.h"
#include "sss/integrate/single_scatter.h"
#include "sss/optics/fresnel.h"
#include "unit/integrate/volume_experiment.h"

namespace sss {
namespace {

using namespace testing;

// The same total the other way round: the sun's light, which only light sampling finds.
TEST(VolumeLight, LightSamplingInsideMatchedBodies) {
    SceneMaker maker = halfSpace(grey(1, 9, 1));
    maker.light(DirectionalLight{{0, -1, 0}, Rgb(1)});
    const Experiment experiment(maker);
    const Estimate e = estimate(512, [&](Sampler& sampler) {
        return kPi * scattered(experiment.trace(cosineDownTo(kHalfSize, sampler), sampler));
    });
    expectWithin(e, DRgb(0.41494747913082), 0.005);
}

// A matched sphere scatters once as integrate/single_scatter says, by sun and by lamp.
TEST(VolumeLight, SingleScatteringOfASphere) {
    RectangleLight lamp;
    lamp.centre = {2, 3, 1};
    lamp.lookAt = {0, 0, 0};
    lamp.up = {0, 0, 1};
    lamp.widthMm = 3;
    lamp.heightMm = 2;
    lamp.radiance = Rgb(5);
    for (const LightSettings& light :
         {LightSettings(lamp), LightSettings(DirectionalLight{{0.2, -1, -0.3}, Rgb(2)})}) {
        TranslucentMaterial material = grey(0.1, 1, 1);
        material.medium.sigmaS = {0.5, 1, 2};
        material.medium.g = {0.6, 0.2, -0.4};
        SceneMaker maker;
        maker.object(SphereShape{1}, maker.material(material));
        maker.light(light);
        const Experiment experiment(maker);
        const World& world = experiment.world();
        Ray ray;
        ray.origin = {0.3f, 0.2f, 3};
        ray.direction = {0, 0, -1};
        const Estimate traced = estimate(
            1024, [&](Sampler& sampler) { return DRgb(experiment.trace(ray, sampler).single); });
        Hit found;
        ASSERT_TRUE(world.rays().intersect(ray, found));
        const SurfaceHit hit = world.surfaceAt(found);
        const Estimate direct = estimate(1024, [&](Sampler& sampler) {
            SingleScatterCounts counts;
            return DRgb(singleScattering(
                world, experiment.optics(), hit, -ray.direction, hit.shadingNormal, sampler,
                [&](const Ray& outward, const Vec3& from, float pdf) {
                    return radianceOfLights(world, outward, std::numeric_limits<float>::infinity(),
                                            {from, pdf});
                },
                counts));
        });
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(traced.mean[c], direct.mean[c],
                        3 * std::hypot(traced.error[c], direct.error[c]));
            EXPECT_LT(traced.error[c], 0.02 * traced.mean[c]);
        }
    }
}

// A lamp behind a matched body: what the floor in its shadow receives is dimmed, not blocked.
TEST(VolumeLight, LightThroughMatchedBodies) {
    SceneMaker maker = slab(grey(0.5, 0, 1), 2);
    maker.object(RectangleShape{50, 50}, maker.material(LambertianMaterial{Rgb(0.5f)}),
                 moved({0, -3, 0}) * turned(-90, {1, 0, 0}));
    maker.light(DirectionalLight{{0, -1, 0}, Rgb(2)});
    const Experiment experiment(maker);
    const Estimate e = estimate(
        64, [&](Sampler& sampler) { return DRgb(experiment.trace(downTo(1), sampler).surface); });
    expectWithin(e, DRgb(0.5 * 2 / kPi * std::exp(-2.0)), 0.01);
}

// A white body on a white floor: all that is seen is 1, however often it went to and fro.
TEST(VolumeLight, WhiteFurnaceWithAFloor) {
    for (const double eta : {1.0, 1.5}) {
        SceneMaker maker;
        maker.scene.quality.bounces = 64;
        maker.object(BoxShape{DVec3(2)}, maker.material(grey(0, 2, eta)));
        maker.object(RectangleShape{50, 50}, maker.material(LambertianMaterial{Rgb(1)}),
                     moved({0, -1.01, 0}) * turned(-90, {1, 0, 0}));
        maker.light(sky());
        const Experiment experiment(maker);
        const Estimate e = estimate(32, [&](Sampler& sampler) {
            return all(experiment.trace(downTo(1, glm::normalize(Vec3(0.6f, 1, 0.3f))), sampler));
        });
        expectWithin(e, DRgb(1), 1e-3, 1e-3);
    }
}

// A lamp in amber: seen by Fresnel, Beer and Lambert; its light is dimmed, not scattered.
TEST(VolumeLight, EmitterInsideABody) {
    for (const double eta : {1.0, 1.5}) {
        TranslucentMaterial amber = grey(0, 0, eta);
        amber.medium.sigmaA = {0.1, 0.3, 0.9};
        SceneMaker maker;
        maker.object(BoxShape{{40, 10, 40}}, maker.material(amber));
        maker.object(RectangleShape{3, 3}, maker.material(EmitterMaterial{Rgb(7), false}),
                     moved({0, 3, 0}) * turned(-90, {1, 0, 0}));
        const Experiment experiment(maker);
        DRgb expected;
        for (int c = 0; c < 3; ++c)
            expected[c] = 7 / (eta * eta) * (1 - fresnelReflectance(1.0, eta)) *
                          std::exp(-2 * amber.medium.sigmaA[c]);
        const Estimate e = estimate(512, [&](Sampler& sampler) {
            return DRgb(experiment.trace(downTo(5), sampler).surface);
        });
        expectWithin(e, expected, 0.03);
    }
}

// Without bodies it is the path tracer of the cached integrator.
TEST(VolumeLight, OpaqueScenesAreThoseOfThePathTracer) {
    MetalMaterial metal;
    metal.roughness = 0.6;  // so wide that the path tracer leaves it as it is
    SceneMaker maker;
    maker.object(RectangleShape{20, 20}, maker.material(LambertianMaterial{{0.8f, 0.5f, 0.2f}}),
                 turned(-90, {1, 0, 0}));
    maker.object(BoxShape{DVec3(2)}, maker.material(metal), moved({1.5, 1.2, 0}));
    RectangleLight lamp;
    lamp.centre = {-4, 5, 2};
    lamp.widthMm = lamp.heightMm = 2;
    lamp.radiance = Rgb(5);
    maker.light(lamp).light(PointLight{{0, 6, 3}, Rgb(2e-5f)}).light(sky(0.3f));
    const Experiment experiment(maker);
    const PathTracer tracer(experiment.world(), {}, {});
    const Ray ray = downTo(0, glm::normalize(Vec3(-0.4f, 1, 0)));
    PathCounts counts;
    const Estimate traced = estimate(
        512, [&](Sampler& sampler) { return DRgb(experiment.trace(ray, sampler).surface); });
    const Estimate expected = estimate(
        512, [&](Sampler& sampler) { return DRgb(tracer.trace(ray, sampler, counts).surface); });
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(traced.mean[c], expected.mean[c],
                    3 * std::hypot(traced.error[c], expected.error[c]));
        EXPECT_LT(traced.error[c], 0.02 * traced.mean[c]);
    }
}

// What the layers say when a material leaves one of them out.
TEST(VolumeLight, LayersAsTheMaterialSaysThem) {
    TranslucentMaterial material = grey(0.5, 5, 1.3);
    const auto seen = [&] {
        SceneMaker maker = halfSpace(material);
        maker.light(sky());
        const Experiment experiment(maker);
        FilmSample sum;
        for (std::uint32_t i = 0; i < 256; ++i) {
            Sampler sampler(3, i);
            const FilmSample s = experiment.trace(downTo(kHalfSize), sampler);
            sum.diffusion += s.diffusion;
            sum.single += s.single;
            sum.surface += s.surface;
        }
        return sum;
    };
    const FilmSample plain = seen();
    EXPECT_GT(plain.single.y, 0);
    EXPECT_GT(plain.surface.y, 0);
    material.singleScattering = false;
    const FilmSample joined = seen();
    EXPECT_EQ(joined.single, Rgb(0));
    EXPECT_NEAR(joined.diffusion.y, plain.diffusion.y + plain.single.y, 1e-3);
    material.multipleScattering = material.surfaceReflection = false;
    const FilmSample nothing = seen();
    EXPECT_EQ(nothing.diffusion, Rgb(0));
    EXPECT_EQ(nothing.surface, Rgb(0));
}

std::string refusal(const SceneMaker& maker) {
    try {
        const Experiment experiment(maker);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::BadInput);
        return e.what();
    }
    return {};
}

TEST(VolumeLight, RefusesWhatItCannotTrace) {
    SceneMaker open;
    open.object(RectangleShape{1, 1}, open.material(grey(1, 1, 1)));
    EXPECT_NE(refusal(open).find("not closed"), std::string::npos);

    TranslucentMaterial material = grey(1, 1, 1.5);
    SceneMaker sunlit = halfSpace(material);
    sunlit.light(DirectionalLight{{0, -1, 0}, Rgb(1)});
    EXPECT_NE(refusal(sunlit).find("directional"), std::string::npos);
    material.roughness = 0.3;
    SceneMaker rough = halfSpace(material);
    rough.light(DirectionalLight{{0, -1, 0}, Rgb(1)});
    EXPECT_EQ(refusal(rough), "");
}

}  // namespace
}  // namespace sss
