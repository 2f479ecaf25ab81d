// The integrator "volume" with rough boundaries.
#include "sss/optics/fresnel.h"
#include "unit/integrate/volume_experiment.h"

namespace sss {
namespace {

using namespace testing;

TranslucentMaterial rough(TranslucentMaterial material, double roughness) {
    material.roughness = roughness;
    return material;
}

// As with smooth ones: nothing is lost between microfacets, path by path.
TEST(RoughVolume, WhiteFurnace) {
    for (const double eta : {0.8, 1.5})
        for (const double roughness : {0.1, 0.3, 0.6}) {
            SCOPED_TRACE(::testing::Message() << eta << ' ' << roughness);
            const TranslucentMaterial white = rough(grey(0, 4, eta), roughness);
            SceneMaker maker;
            // Bent normals, and light that comes back.
            if (roughness == 0.3) {
                maker.object(SphereShape{1}, maker.material(white));
            } else {
                const int both = maker.material(white);
                maker.object(BoxShape{DVec3(2)}, both).group = "pair";
                maker.object(BoxShape{DVec3(1)}, both, moved({0, 1.6, 0})).group = "pair";
            }
            maker.light(sky());
            expectWhiteFurnace(maker);
        }
}

// The half-space of [Giovanelli 1955] again, as by adding-doubling when smooth.
TEST(RoughVolume, TendsToTheSmoothOne) {
    SceneMaker maker = halfSpace(rough(grey(1, 9, 1.5), 0.011));
    maker.light(sky());
    const Experiment experiment(maker);
    DRgb surface(0);
    const Estimate inside = estimate(512, [&](Sampler& sampler) {
        const FilmSample sample = experiment.trace(downTo(kHalfSize), sampler);
        surface += DRgb(sample.surface) / (32.0 * 512.0);
        return scattered(sample);
    });
    expectWithin(inside, DRgb(0.22), 0.003, 1e-4);
    EXPECT_NEAR(surface.y, 0.04, 0.005);
}

// What comes back from a rough boundary comes back of it both ways: seen along one direction under
// light from everywhere, and lit along it and seen from everywhere. The latter by light sampling,
// which the former does without.
TEST(RoughVolume, LightSamplingAsByPathsThatFindTheSky) {
    const auto body = [] { return halfSpace(rough(grey(1, 9, 1.4), 0.6)); };
    SceneMaker under = body(), lit = body();
    under.light(sky());
    lit.light(DirectionalLight{{0, -1, 0}, Rgb(1)});
    const Experiment ofSky(under), ofSun(lit);
    const auto parts = [](const FilmSample& s) {
        return DRgb(DRgb(s.surface).y, DRgb(s.single).y, DRgb(s.diffusion).y);
    };
    const Estimate seen = estimate(
        1024, [&](Sampler& sampler) { return parts(ofSky.trace(downTo(kHalfSize), sampler)); });
    const Estimate sent = estimate(1024, [&](Sampler& sampler) {
        return kPi * parts(ofSun.trace(cosineDownTo(kHalfSize, sampler), sampler));
    });
    for (int part = 0; part < 3; ++part) {
        EXPECT_NEAR(sent.mean[part], seen.mean[part],
                    3 * std::hypot(sent.error[part], seen.error[part]))
            << "part " << part;
        EXPECT_LT(sent.error[part], 0.08 * seen.mean[part]);
    }
}

// A spot on a rough sphere with bent normals: light sampling against a lamp as small as the sun,
// which paths find by chance.
TEST(RoughVolume, LightSamplingWithBentNormals) {
    RectangleLight lamp;
    lamp.centre = {6, 7, 5};
    lamp.lookAt = {0, 0, 0};
    lamp.up = {0, 1, 0};
    lamp.widthMm = lamp.heightMm = 3;
    lamp.radiance = Rgb(1);
    const double distance = std::sqrt(110.0);
    const auto body = [] {
        SceneMaker maker;
        maker.object(SphereShape{1}, maker.material(rough(grey(0.2, 2, 1.4), 0.7)));
        return maker;
    };
    SceneMaker byLamp = body(), byPoint = body();
    byLamp.light(lamp);
    byPoint.light(
        DirectionalLight{-lamp.centre, Rgb(static_cast<float>(9 / (distance * distance)))});
    const Experiment found(byLamp), sampled(byPoint);
    Ray ray;
    ray.origin = {0.4f, 0.3f, 4};
    ray.direction = {0, 0, -1};
    const Estimate a = estimate(4096, [&](Sampler& s) { return all(found.trace(ray, s)); });
    const Estimate b = estimate(512, [&](Sampler& s) { return all(sampled.trace(ray, s)); });
    // The lamp has a size, and is near.
    expectWithin({a.mean, DRgb(std::hypot(a.error.y, b.error.y))}, b.mean, 0.04 * b.mean.y,
                 0.03 * b.mean.y);
}

}  // namespace
}  // namespace sss
