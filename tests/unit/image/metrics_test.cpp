#include "sss/image/metrics.h"

#include "sss/base/error.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace sss
