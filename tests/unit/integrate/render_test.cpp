#include "sss/base/parallel.h"
#include "sss/integrate/irradiance.h"
#include "sss/integrate/renderer.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "sss/scene/scene_reader.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::grey;
using testing::measured;
using testing::picture;
using testing::SceneMaker;
using testing::value;

// A ball of something that absorbs nothing, in light that is the same all around, cannot be seen:
// what it reflects, scatters once and scatters many times adds up to what it hides. But for what a
// profile of the plane sends farther than the ball reaches: as much area of a sphere lies within a
// distance as of a plane, so the tail beyond the diameter is missing.
TEST(Render, WhiteFurnace) {
    SceneMaker maker;
    TranslucentMaterial white = measured("Spectralon");
    maker.object(SphereShape{2}, maker.material(white));  // some 40 mean free paths across
    maker.light(EnvironmentLight{Rgb(1.5f), {}, 0});
    maker.scene.camera.position = {0, 0, 40};
    maker.scene.camera.fovDegrees = 2 * 180 / kPi * std::asin(2 / 40.0);  // the ball fills it
    maker.scene.film.width = maker.scene.film.height = 4;
    maker.scene.film.samples = 2048;
    maker.scene.quality.bounces = 0;
    maker.scene.quality.tolerance = 0.02;
    const LayeredImage image = picture(maker.scene);
    const BodyOptics optics(white);
    DRgb mean(0);
    int n = 0;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            if (std::hypot(x - 1.5, y - 1.5) > 1.6) continue;
            ++n;
            const double offset = std::hypot(x - 1.5, y - 1.5) / 2;
            const double leaving = 1 - fresnelReflectance(std::sqrt(1 - offset * offset), 1.3);
            for (int c = 0; c < 3; ++c) {
                const double lost = static_cast<double>(optics.multipleScale[c]) *
                                    optics.profiles[static_cast<std::size_t>(c)]->tail(4) * leaving;
                EXPECT_LT(lost, 0.06);
                const double v = value(image, "", x, y, c) / 1.5 + lost;
                EXPECT_NEAR(v, 1, 0.02) << x << ' ' << y << ' ' << c;
                mean[c] += v;
            }
        }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / n, 1, 0.01);
}

// A plane much larger than the reach of diffusion, in sunlight.
struct SunnyPlane {
    double cosSun = 0.8, eta = 1.4;
    double cosOut = std::cos(glm::radians(35.0));
    TranslucentMaterial material = grey(0.2, 4, eta);  // reach 1/sigma_tr = 0.63 mm
    double transmittedSun = 2 * cosSun * (1 - fresnelReflectance(cosSun, eta));
    SceneMaker maker;

    explicit SunnyPlane(int samples) {
        maker.object(BoxShape{{14, 5, 14}}, maker.material(material));
        maker.light(DirectionalLight{{-0.6, -cosSun, 0}, Rgb(2)});
        maker.scene.camera.position = {0, 2.5 + 30 * cosOut, 30 * std::sqrt(1 - cosOut * cosOut)};
        maker.scene.camera.lookAt = {0, 2.5, 0};
        maker.scene.camera.fovDegrees = 2;
        maker.scene.film.width = maker.scene.film.height = 8;
        maker.scene.film.samples = samples;
        maker.scene.quality.tolerance = 0.01;
    }

    // What is seen of light scattered once.
    double single() const {
        const double muI = refractedCosine(cosSun, eta), muO = refractedCosine(cosOut, eta);
        return material.medium.channel(0).albedo() / (4 * kPi) * transmittedSun *
               (1 - fresnelReflectance(cosOut, eta)) / (eta * eta * (muI + muO));
    }
};

// The closed form of each layer.
TEST(Render, EvenlyLitPlane) {
    const SunnyPlane plane(256);
    const LayeredImage image = picture(plane.maker.scene);

    const World world = plane.maker.world();
    const auto optics = makeBodyOptics(world);
    const double expected = static_cast<double>(optics[0]->multipleScale.x) *
                            optics[0]->profiles[0]->total() * plane.transmittedSun *
                            (1 - fresnelReflectance(plane.cosOut, plane.eta)) /
                            (kPi * hemisphericalTransmittance(plane.eta));
    double diffusionMean = 0, singleMean = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            EXPECT_NEAR(value(image, "diffusion", x, y, 0), expected, 0.01 * expected);
            diffusionMean += value(image, "diffusion", x, y, 0) / 64;
            singleMean += value(image, "single", x, y, 0) / 64;
            EXPECT_EQ(value(image, "", x, y, 3), 1);
            EXPECT_NEAR(value(image, "N", x, y, 1), 1, 1e-5);
            EXPECT_NEAR(value(image, "Z", x, y, 0), 30, 0.5);
        }
    EXPECT_NEAR(diffusionMean, expected, 0.005 * expected);
    EXPECT_NEAR(singleMean, plane.single(), 0.01 * plane.single());
}

// Not every sample looks for single scattering, but those that do stand for the others, however
// many there are.
TEST(Render, FewSamplesShowAllSingleScattering) {
    for (const int samples : {1, 3, 12, 17}) {
        SCOPED_TRACE(samples);
        SunnyPlane plane(samples);
        plane.maker.scene.film.width = plane.maker.scene.film.height = 64;
        plane.maker.scene.quality.tolerance = 0.5;
        const LayeredImage image = picture(plane.maker.scene);
        double mean = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) mean += value(image, "single", x, y, 0) / (64 * 64);
        EXPECT_NEAR(mean, plane.single(), 0.04 * plane.single());
    }
}

SceneMaker smallScene() {
    SceneMaker maker;
    TranslucentMaterial marble = measured("Marble"), milk = measured("Skimmilk");
    marble.roughness = 0.3;
    maker.object(SphereShape{4}, maker.material(marble));
    maker.object(BoxShape{DVec3(4)}, maker.material(milk),
                 testing::moved({7, -1, 0}) * testing::turned(30, {0, 1, 0}));
    maker.object(RectangleShape{60, 60}, maker.material(LambertianMaterial{}),
                 testing::moved({0, -4, 0}) * testing::turned(-90, {1, 0, 0}));
    RectangleLight lamp;
    lamp.centre = {-15, 20, 10};
    lamp.widthMm = lamp.heightMm = 8;
    lamp.radiance = Rgb(6, 5, 4);
    maker.light(lamp);
    maker.light(EnvironmentLight{Rgb(0.2f), {}, 0});
    maker.scene.camera.position = {3, 8, 30};
    maker.scene.camera.lookAt = {3, -1, 0};
    maker.scene.camera.fovDegrees = 30;
    maker.scene.film.width = 24;
    maker.scene.film.height = 20;
    maker.scene.quality.bounces = 2;
    maker.scene.quality.tolerance = 0.1;
    return maker;
}

TEST(Render, LayersSumToTheBeauty) {
    const LayeredImage image = picture(smallScene().scene);
    double parts[3] = {0, 0, 0};
    const char* names[3] = {"diffusion", "single", "surface"};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) {
                double sum = 0;
                for (int k = 0; k < 3; ++k) {
                    parts[k] += value(image, names[k], x, y, c);
                    sum += value(image, names[k], x, y, c);
                }
                ASSERT_NEAR(value(image, "", x, y, c), sum, 1e-6 * (1 + sum));
            }
    for (int k = 0; k < 3; ++k) EXPECT_GT(parts[k], 0) << names[k];
}

// Tiles and points go to whatever thread is free: their order must not show either.
TEST(Render, ThreadsDoNotMatter) {
    const Scene scene = smallScene().scene;
    std::vector<LayeredImage> pictures;
    for (const unsigned threads : {1u, 2u, 5u}) {
        const ThreadLimit limit(threads);
        pictures.push_back(picture(scene));
    }
    for (const LayeredImage& other : {pictures[1], pictures[2]})
        for (const ImageLayer& layer : pictures[0].layers)
            EXPECT_EQ(other.find(layer.name)->values, layer.values) << layer.name;
}

TEST(Render, SwitchesTurnLayersOff) {
    SceneMaker maker = smallScene();
    for (NamedMaterial& m : maker.scene.materials)
        if (auto* translucent = std::get_if<TranslucentMaterial>(&m.material)) {
            translucent->singleScattering = false;
            translucent->multipleScattering = false;
            translucent->surfaceReflection = false;
        }
    const LayeredImage image = picture(maker.scene);
    for (const char* layer : {"diffusion", "single"})
        for (const float v : image.find(layer)->values) ASSERT_EQ(v, 0);
    // The middle of the ball, then, is black.
    const LayeredImage ball = [&] {
        maker.scene.camera.lookAt = {0, 0, 0};
        maker.scene.camera.fovDegrees = 2;
        return picture(maker.scene);
    }();
    EXPECT_EQ(value(ball, "", 12, 10, 1), 0);
    EXPECT_EQ(value(ball, "", 12, 10, 3), 1);
}

/// Largest difference of the beauties, relative to the brightest value.
double largestDifference(const LayeredImage& a, const LayeredImage& b) {
    double largest = 0, brightest = 0;
    const std::vector<float>&u = a.find("")->values, &v = b.find("")->values;
    for (std::size_t i = 0; i < u.size(); ++i) {
        largest = std::max(largest, static_cast<double>(std::abs(u[i] - v[i])));
        brightest = std::max(brightest, static_cast<double>(u[i]));
    }
    return largest / brightest;
}

TEST(Render, UnitsDoNotMatter) {
    std::vector<LayeredImage> pictures;
    for (const char* unit : {"mm", "cm", "m"}) {
        Scene scene = readScene(std::filesystem::path(SSS_SOURCE_DIR) / "scenes/units" /
                                (std::string(unit) + ".json"));
        scene.film.width = scene.film.height = 24;
        pictures.push_back(picture(scene));
    }
    EXPECT_LT(largestDifference(pictures[0], pictures[1]), 1e-3);
    EXPECT_LT(largestDifference(pictures[0], pictures[2]), 1e-3);
}

TEST(Render, PlaceDoesNotMatter) {
    const DVec3 away(1e6, -3e5, 2e6);
    SceneMaker home = smallScene(), far = smallScene();
    for (ObjectSettings& object : far.scene.objects)
        object.transform.emplace_back(testing::moved(away));
    far.scene.camera.position += away;
    far.scene.camera.lookAt += away;
    auto& lamp = std::get<RectangleLight>(far.scene.lights[0]);
    lamp.centre += away;
    lamp.lookAt += away;
    EXPECT_LT(largestDifference(picture(home.scene), picture(far.scene)), 1e-4);
}

// Twice as large in a medium half as dense: the same picture. By rounding a sum may take a node
// that it would have opened, or the other way round: a small tolerance keeps that below what is
// looked for.
TEST(Render, ScaleDoesNotMatter) {
    SceneMaker small = smallScene();
    small.scene.quality.tolerance = 0.02;
    for (const double factor : {1e-3, 1e4}) {
        SceneMaker other = small;
        for (ObjectSettings& object : other.scene.objects)
            object.transform.emplace_back(glm::scale(DMat4(1.0), DVec3(factor)));
        for (NamedMaterial& m : other.scene.materials)
            if (auto* translucent = std::get_if<TranslucentMaterial>(&m.material)) {
                translucent->medium.sigmaA /= factor;
                translucent->medium.sigmaS /= factor;
            }
        other.scene.camera.position *= factor;
        other.scene.camera.lookAt *= factor;
        auto& lamp = std::get<RectangleLight>(other.scene.lights[0]);
        lamp.centre *= factor;
        lamp.widthMm *= factor;
        lamp.heightMm *= factor;
        EXPECT_LT(largestDifference(picture(small.scene), picture(other.scene)), 1e-4) << factor;
    }
}

}  // namespace
}  // namespace sss
