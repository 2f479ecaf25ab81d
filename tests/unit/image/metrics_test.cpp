#include "sss/image/metrics.h"

#include "sss/base/error.h"
#include "sss/image/error_image.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace sss {
namespace {

TEST(Metrics, FiguresByHand) {
    const ImageLayer reference{"", {"R", "G", "B", "A"}, {1, 2, 3, 1, 4, 0, 2, 1}, false};
    ImageLayer picture = reference;
    picture.values = {1.5f, 2, 3, 0, 4, 0, 1, 0};  // +0.5, -1; alpha does not count
    const ImageDifference d = compareLayers(picture, reference);
    EXPECT_EQ(d.pixels, 2u);
    EXPECT_NEAR(d.relativeRmse, std::sqrt(1.25 / 6) / 2, 1e-12);
    EXPECT_NEAR(d.bias, -0.5 / 6 / 2, 1e-12);
    EXPECT_NEAR(d.maximum, 0.5, 1e-12);
}

TEST(Metrics, MaskChoosesPixels) {
    const ImageLayer reference{"", {"Y"}, {1, 10, 3}, false};
    const ImageLayer picture{"", {"Y"}, {1.1f, 99, 3}, false};
    const ImageLayer mask{"body", {"body"}, {0.5f, 0, 1}, false};
    const ImageDifference d = compareLayers(picture, reference, &mask);
    EXPECT_EQ(d.pixels, 2u);
    EXPECT_NEAR(d.bias, 0.025, 1e-7);
    const ImageLayer nothing{"", {"Y"}, {0, 0, 0}, false};
    EXPECT_EQ(compareLayers(picture, reference, &nothing).pixels, 0u);
    EXPECT_EQ(compareLayers(picture, reference, &nothing).relativeRmse, 0);
}

TEST(Metrics, DegenerateReferences) {
    const ImageLayer black{"", {"Y"}, {0, 0}, false}, grey{"", {"Y"}, {1, 1}, false};
    EXPECT_EQ(compareLayers(black, black).relativeRmse, 0);
    EXPECT_TRUE(std::isinf(compareLayers(grey, black).relativeRmse));
    const ImageLayer broken{"", {"Y"}, {std::nanf(""), 1}, false};
    const ImageDifference d = compareLayers(broken, grey);
    EXPECT_TRUE(std::isnan(d.relativeRmse));
    EXPECT_TRUE(std::isnan(d.bias));
    EXPECT_TRUE(std::isnan(d.maximum));
}

TEST(Metrics, DifferentShapesAreRefused) {
    const ImageLayer a{"", {"Y"}, {1, 2}, false}, b{"", {"Y"}, {1}, false};
    const ImageLayer c{"", {"R"}, {1, 2}, false};
    EXPECT_THROW(compareLayers(a, b), Error);
    EXPECT_THROW(compareLayers(a, c), Error);
    EXPECT_THROW(compareLayers(a, a, &b), Error);
}

TEST(Metrics, StandardErrorsOfIndependentPictures) {
    const std::vector<double> biases{0.1, 0.2, 0.3, 0.4};
    const MeanAndError bias = meanOver(biases);
    EXPECT_NEAR(bias.mean, 0.25, 1e-15);
    EXPECT_NEAR(bias.error, std::sqrt(0.05 / 3 / 4), 1e-15);  // squares 0.15^2, 0.05^2, twice each
    const MeanAndError alone = meanOver({biases.data(), 1});
    EXPECT_EQ(alone.mean, 0.1);
    EXPECT_TRUE(std::isnan(alone.error));
}

std::array<int, 3> pixel(const Picture8& picture, std::size_t index) {
    return {picture.values[3 * index], picture.values[3 * index + 1],
            picture.values[3 * index + 2]};
}

TEST(Metrics, ErrorImageByDecades) {
    // The mean of the reference under the mask is 2.
    const ImageLayer reference{"", {"R", "A"}, {2, 1, 2, 1, 2, 1, 2, 1, 2, 1, 9, 1}, false};
    ImageLayer picture = reference;
    picture.values = {2, 0, 2.002f, 1, 1.98f, 1, 2.2f, 1, 9, 1, 0, 1};
    const ImageLayer mask{"m", {"m"}, {1, 1, 1, 1, 1, 0}, false};
    const Picture8 image = errorImage(picture, reference, 3, &mask);
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 2);
    const std::array<int, 3> black{0, 0, 4}, white{252, 255, 164}, grey{96, 96, 96};
    EXPECT_EQ(pixel(image, 0), black);
    EXPECT_EQ(pixel(image, 4), white);
    EXPECT_EQ(pixel(image, 5), grey);
    const auto near = [&](std::size_t index, const std::array<int, 3>& expected) {
        const auto found = pixel(image, index);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1) << index;
    };
    near(1, black);           // 0.001
    near(2, {120, 28, 109});  // 0.01
    near(3, {237, 105, 37});  // 0.1
    picture.values[2] = std::nanf("");
    EXPECT_EQ(pixel(errorImage(picture, reference, 3, &mask), 1), (std::array<int, 3>{0, 255, 0}));
    EXPECT_THROW(errorImage(picture, mask, 3), Error);
}

}  // namespace
}  // namespace sss
