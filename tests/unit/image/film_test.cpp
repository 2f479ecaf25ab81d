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

template <typename Sample>
FilmPixel pixelOf(int samples, const Sample& sample) {
    FilmPixel pixel;
    for (int s = 0; s < samples; ++s) pixel.add(sample());
    return pixel;
}

float value(const LayeredImage& image, const std::string& layer, std::size_t index) {
    return image.find(layer)->values.at(index);
}

TEST(Film, BeautyIsExactlyTheSumOfItsParts) {
    Film film(5, 3, {"surface", "diffusion", "single"});
    Rng rng(4);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x) film.set(x, y, pixelOf(7, [&] { return randomSample(rng); }));
    const LayeredImage image = std::move(film).take();
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
    FilmPixel pixel;
    FilmSample hit;
    hit.diffusion = {1, 2, 3};
    hit.alpha = 1;
    hit.albedo = Rgb{0.5f};
    hit.normal = {0, 1, 0};
    hit.depth = 10;
    pixel.add(hit);
    hit.depth = 20;
    hit.diffusion = {3, 2, 1};
    pixel.add(hit);
    FilmSample miss;
    miss.surface = Rgb{0.5f};
    pixel.add(miss);
    pixel.add(miss);
    film.set(0, 0, pixel);

    const LayeredImage image = std::move(film).take();
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
    const auto coloured = [&] {
        FilmSample sample;
        sample.surface = randomColour(rng);
        return sample;
    };
    for (int x = 0; x < pixels; ++x) film.set(x, 0, pixelOf(samples, coloured));
    const LayeredImage image = std::move(film).take();
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
    FilmPixel last, middle, first;
    FilmSample bad = good;
    bad.single.y = nan;
    first.add(bad);
    bad = good;
    bad.surface.x = infinity;
    first.add(bad);
    bad = good;
    bad.diffusion.z = -1e-6f;
    last.add(bad);
    bad = good;
    bad.normal.x = nan;
    last.add(bad);
    bad = good;
    bad.depth = nan;
    middle.add(bad);
    first.add(good);
    film.set(1, 2, last);
    film.set(3, 1, middle);
    film.set(2, 1, first);

    const Film::Dropped dropped = film.dropped();
    EXPECT_EQ(dropped.samples, 5u);
    EXPECT_EQ(dropped.firstX, 2);
    EXPECT_EQ(dropped.firstY, 1);
    const LayeredImage image = std::move(film).take();
    EXPECT_EQ(value(image, "", (4 + 2) * 4), 2.0f);
    EXPECT_EQ(value(image, "sampleCount", 4 + 2), 1.0f);
    for (const float v : image.find("")->values) EXPECT_TRUE(std::isfinite(v));
    EXPECT_EQ(Film(2, 2, {}).dropped().samples, 0u);
}

TEST(Film, PixelsNobodyHitHaveNoDepth) {
    Film film(2, 1, {"Z"});
    film.set(0, 0, pixelOf(1, [] { return FilmSample{}; }));
    EXPECT_EQ(std::move(film).take().find("Z")->values, (std::vector<float>{kNoDepth, kNoDepth}));
}

TEST(Film, PixelsThatAreNotSetHoldWhatIsEverywhere) {
    FilmSample background;
    background.surface = {1, 2, 3};
    Film film(2, 2, {"surface", "sampleCount"}, pixelOf(3, [&] { return background; }));
    film.set(1, 0, FilmPixel{});
    const LayeredImage image = std::move(film).take();
    EXPECT_EQ(image.find("surface")->values,
              (std::vector<float>{1, 2, 3, 0, 0, 0, 1, 2, 3, 1, 2, 3}));
    EXPECT_EQ(image.find("sampleCount")->values, (std::vector<float>{3, 0, 3, 3}));
    EXPECT_EQ(value(image, "", 8 + 2), 3.0f);
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
