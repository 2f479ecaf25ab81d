#include "sss/image/film.h"

#include "sss/base/error.h"
#include "sss/base/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sss {
namespace {

const std::vector<std::string> kAll{"diffusion", "single", "surface",  "albedo",
                                    "N",         "Z",      "variance", "sampleCount"};

Rgb randomColour(Rng& rng) { return {rng.uniform(), rng.uniform(), rng.uniform()}; }

FilmSample randomSample(Rng& rng) {
    FilmSample sample;
    sample.diffusion = randomColour(rng);
    sample.single = randomColour(rng);
    sample.surface = randomColour(rng) * 100.0f;
    sample.alpha = 1;
    return sample;
}

float value(const LayeredImage& image, const std::string& layer, std::size_t index) {
    return image.find(layer)->values.at(index);
}

TEST(Film, BeautyIsExactlyTheSumOfItsParts) {
    Film film(5, 3, {"surface", "diffusion", "single"});
    Rng rng(4);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x)
            for (int s = 0; s < 7; ++s) film.add(x, y, randomSample(rng));
    const LayeredImage image = film.develop();
    for (std::size_t pixel = 0; pixel < 15; ++pixel) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float sum = value(image, "diffusion", pixel * 3 + c) +
                              value(image, "single", pixel * 3 + c) +
                              value(image, "surface", pixel * 3 + c);
            EXPECT_EQ(value(image, "", pixel * 4 + c), sum);
        }
        EXPECT_EQ(value(image, "", pixel * 4 + 3), 1.0f);
    }
}

TEST(Film, LayersAreMeansInTheOrderAskedFor) {
    Film film(1, 1, kAll);
    FilmSample hit;
    hit.diffusion = {1, 2, 3};
    hit.alpha = 1;
    hit.albedo = Rgb{0.5f};
    hit.normal = {0, 1, 0};
    hit.depth = 10;
    film.add(0, 0, hit);
    hit.depth = 20;
    hit.diffusion = {3, 2, 1};
    film.add(0, 0, hit);
    FilmSample miss;
    miss.surface = Rgb{0.5f};
    film.add(0, 0, miss);
    film.add(0, 0, miss);

    const LayeredImage image = film.develop();
    ASSERT_EQ(image.layers.size(), 9u);
    for (std::size_t i = 0; i < kAll.size(); ++i) EXPECT_EQ(image.layers[i + 1].name, kAll[i]);
    EXPECT_EQ(image.find("diffusion")->values, (std::vector<float>{1, 1, 1}));
    EXPECT_EQ(image.find("")->values, (std::vector<float>{1.25f, 1.25f, 1.25f, 0.5f}));
    EXPECT_EQ(image.find("albedo")->values, (std::vector<float>{0.25f, 0.25f, 0.25f}));
    EXPECT_EQ(image.find("N")->values, (std::vector<float>{0, 0.5f, 0}));
    EXPECT_EQ(value(image, "Z", 0), 15.0f);
    EXPECT_EQ(value(image, "sampleCount", 0), 4.0f);
    // Red: 1, 3, 0.5, 0.5: variance of the mean = sum of squared deviations / 12.
    EXPECT_NEAR(value(image, "variance", 0), (0.0625 + 3.0625 + 2 * 0.5625) / 12, 1e-6);
}

TEST(Film, VariancePredictsTheSpreadOfTheMean) {
    Rng rng(9);
    const int pixels = 2000, samples = 16;
    Film film(pixels, 1, {"variance"});
    for (int x = 0; x < pixels; ++x)
        for (int s = 0; s < samples; ++s) {
            FilmSample sample;
            sample.surface = randomColour(rng);
            film.add(x, 0, sample);
        }
    const LayeredImage image = film.develop();
    double estimated = 0, squares = 0;
    for (std::size_t x = 0; x < pixels; ++x) {
        estimated += static_cast<double>(value(image, "variance", x * 3));
        const double deviation = static_cast<double>(value(image, "", x * 4)) - 0.5;
        squares += deviation * deviation;
    }
    const double expected = 1.0 / 12 / samples;
    EXPECT_NEAR(estimated / pixels, expected, 0.02 * expected);
    EXPECT_NEAR(squares / pixels, expected, 0.1 * expected);
}

TEST(Film, UnusableSamplesAreDroppedAndCounted) {
    Film film(4, 3, {"sampleCount"});
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    FilmSample good;
    good.diffusion = Rgb{2.0f};
    FilmSample bad = good;
    bad.single.y = nan;
    film.add(2, 1, bad);
    bad = good;
    bad.surface.x = infinity;
    film.add(2, 1, bad);
    bad = good;
    bad.diffusion.z = -1e-6f;
    film.add(1, 2, bad);
    bad = good;
    bad.normal.x = nan;
    film.add(1, 2, bad);
    bad = good;
    bad.depth = nan;
    film.add(3, 1, bad);
    film.add(2, 1, good);

    const Film::Dropped dropped = film.dropped();
    EXPECT_EQ(dropped.samples, 5u);
    EXPECT_EQ(dropped.firstX, 2);
    EXPECT_EQ(dropped.firstY, 1);
    const LayeredImage image = film.develop();
    EXPECT_EQ(value(image, "", (4 + 2) * 4), 2.0f);
    EXPECT_EQ(value(image, "sampleCount", 4 + 2), 1.0f);
    for (const float v : image.find("")->values) EXPECT_TRUE(std::isfinite(v));
    EXPECT_EQ(Film(2, 2, {}).dropped().samples, 0u);
}

TEST(Film, PixelsNobodyHitHaveNoDepth) {
    Film film(2, 1, {"Z"});
    film.add(0, 0, FilmSample{});
    EXPECT_EQ(film.develop().find("Z")->values, (std::vector<float>{kNoDepth, kNoDepth}));
}

TEST(Film, UnknownAndRepeatedLayersAreNamed) {
    try {
        Film(1, 1, {"difusion"});
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("difusion"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("sampleCount"), std::string::npos);
    }
    EXPECT_THROW(Film(1, 1, {"Z", "Z"}), Error);
}

}  // namespace
}  // namespace sss
