// What is not computed because it brings nothing, or is known already.
#include "sss/integrate/body_optics.h"
#include "sss/integrate/single_scatter.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::grey;
using testing::MadeClouds;
using testing::measured;
using testing::SceneMaker;

// The same coefficients through a different profile object: a channel apart by the last bit.
TranslucentMaterial nearlyGrey(const TranslucentMaterial& material) {
    TranslucentMaterial apart = material;
    apart.medium.sigmaA.y = std::nextafter(apart.medium.sigmaA.x, 1.0);
    apart.medium.sigmaA.z = std::nextafter(apart.medium.sigmaA.y, 1.0);
    return apart;
}

TEST(EqualChannels, AreKnownByTheirCoefficients) {
    EXPECT_EQ(BodyOptics(measured("Marble")).equalChannels(), 0);
    const TranslucentMaterial material = grey(0.1, 2, 1.3);
    const BodyOptics all(material);
    EXPECT_EQ(all.equalChannels(), 2);
    EXPECT_EQ(all.profiles[0], all.profiles[2]);
    TranslucentMaterial two = material;
    two.medium.sigmaS.y = 1;  // red and blue are left alike
    const BodyOptics pair(two);
    EXPECT_EQ(pair.equalChannels(), 1);
    EXPECT_EQ(pair.firstLike(1), 1);
    EXPECT_EQ(pair.firstLike(2), 0);
    const TranslucentMaterial none = nearlyGrey(material);
    EXPECT_EQ(BodyOptics(none).equalChannels(), 0);
}

// Tables, spacing and energy of a shared profile are those of three profiles of their own.
TEST(EqualChannels, ChangeNothing) {
    for (const char* profile : {"dipole", "normalized_diffusion"}) {
        TranslucentMaterial material = grey(0.1, 2, 1.3), apart = nearlyGrey(material);
        material.profile = apart.profile = profile;
        const BodyOptics shared(material), own(apart);
        EXPECT_NEAR(spacingFor(shared, 0.01).spacingMm / spacingFor(own, 0.01).spacingMm, 1, 1e-9);
        EXPECT_NEAR(expectedQuadratureError(shared, 0.2) / expectedQuadratureError(own, 0.2), 1,
                    1e-9);
        const KernelTable a(shared.profilePointers(), 20, 0.1), b(own.profilePointers(), 20, 0.1);
        ASSERT_EQ(a.rowCount(), b.rowCount());
        for (float r = 0; r < 20; r += 0.37f) {
            const Rgb value = a.evaluate(r * r);
            EXPECT_EQ(value.x, value.y);
            EXPECT_EQ(value.x, value.z);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(value[c], b.evaluate(r * r)[c], 1e-6f * value[c]) << r;
                for (int k = 0; k < 4; ++k) {
                    const float bound = a.boundsAt(r * r).derivative[k][c];
                    EXPECT_NEAR(bound, b.boundsAt(r * r).derivative[k][c], 1e-4f * bound) << r;
                }
            }
        }
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(shared.multipleScale[c], shared.multipleScale.x);
            EXPECT_NEAR(shared.multipleScale[c], own.multipleScale[c], 1e-6f);
        }
    }
}

TEST(EqualChannels, GiveTheSamePicture) {
    std::vector<LayeredImage> pictures;
    for (const bool isApart : {false, true}) {
        SceneMaker maker;
        const TranslucentMaterial material = grey(0.1, 2, 1.3);
        maker.object(BoxShape{DVec3(8)}, maker.material(isApart ? nearlyGrey(material) : material));
        maker.light(DirectionalLight{{-1, -2, -0.5}, Rgb(3, 2, 1)});
        maker.scene.camera.position = {6, 9, 20};
        maker.scene.quality.irradianceSamples = 4;
        pictures.push_back(testing::picture(maker.scene));
    }
    double sum = 0;
    for (const char* layer : {"diffusion", "single"}) {
        const std::vector<float>&a = pictures[0].find(layer)->values,
              &b = pictures[1].find(layer)->values;
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_NEAR(a[i], b[i], 1e-5f * a[i] + 1e-9f) << layer << ' ' << i;
            sum += static_cast<double>(a[i]);
        }
    }
    EXPECT_GT(sum, 0);
}

// Media alike may have been made from colours that are not: as much is taken off each.
TEST(EqualChannels, KeepTheColoursTheyShow) {
    TranslucentMaterial material = grey(0.1, 2, 1.3);
    material.diffuseColor = DRgb(0.6, 0.6, 0.5);
    const BodyOptics optics(material);
    EXPECT_EQ(optics.equalChannels(), 2);
    EXPECT_EQ(optics.multipleScale.x, optics.multipleScale.y);
    EXPECT_LT(optics.multipleScale.z, optics.multipleScale.x);
}

// Two balls: a lamp that shines to one side only stands between them, close to the lit one.
SceneMaker litAndUnlit() {
    SceneMaker maker;
    const int milk = maker.material(measured("Skimmilk"));
    maker.object(SphereShape{3}, milk, testing::moved({8, 0, 0}));
    maker.object(SphereShape{3}, milk, testing::moved({-60, 0, 0}));
    RectangleLight lamp;
    lamp.widthMm = lamp.heightMm = 6;
    lamp.radiance = Rgb(5);
    lamp.centre = {0, 0, 0};
    lamp.lookAt = {8, 0, 0};
    maker.light(lamp);
    maker.scene.camera.position = {-26, 0, 220};
    maker.scene.camera.lookAt = {-26, 0, 0};
    maker.scene.camera.fovDegrees = 14;
    maker.scene.film.width = 48;
    maker.scene.film.height = 32;
    maker.scene.film.samples = 8;
    maker.scene.quality.bounces = 0;
    maker.scene.quality.spacingMm = 0.6;
    return maker;
}

TEST(SingleScattering, IsLeftOutWhereNoLightIsInReach) {
    for (const int bounces : {0, 1}) {
        SceneMaker maker = litAndUnlit();
        maker.scene.quality.bounces = bounces;
        const World world = maker.world();
        std::vector<RenderResult> results;
        for (const bool isLeftOut : {true, false}) {
            const auto optics = makeBodyOptics(world);
            ASSERT_GT(optics[0]->singleReachMm, 0);
            ASSERT_LT(optics[0]->singleReachMm, 40);
            // As far as the lamp's other side: nothing is left out then.
            for (const auto& body : optics)
                if (!isLeftOut) body->singleReachMm = 1000;
            const MadeClouds made(world, optics);
            results.push_back(testing::resultFrom(
                world, optics, [&](std::size_t b) { return made.clouds[b].view(); }));
        }
        // With bounces, light may come from any surface that gets some.
        EXPECT_EQ(results[0].counts.singleSkipped > 0, bounces == 0);
        EXPECT_GT(results[0].counts.singleSamples, 0u);
        EXPECT_EQ(results[1].counts.singleSkipped, 0u);
        EXPECT_EQ(results[0].counts.singleSkipped + results[0].counts.singleSamples,
                  results[1].counts.singleSamples);
        for (const ImageLayer& layer : results[0].image.layers)
            EXPECT_EQ(layer.values, results[1].image.find(layer.name)->values) << layer.name;
        double single = 0;
        for (const float v : results[0].image.find("single")->values)
            single += static_cast<double>(v);
        EXPECT_GT(single, 0);
    }
}

TEST(SingleScattering, ReachesAsFarAsAnyoneNotices) {
    TranslucentMaterial material = grey(0.5, 1.5, 1.3);
    material.medium.sigmaS.y = 0;  // scatters nothing, however clear
    EXPECT_NEAR(std::exp(-2 * static_cast<double>(BodyOptics(material).singleReachMm)), 1e-6, 5e-7);
    EXPECT_EQ(BodyOptics(grey(1, 0, 1.3)).singleReachMm, 0);
}

}  // namespace
}  // namespace sss
