#include "sss/image/rgb_map.h"

#include "sss/base/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sss {
namespace {

LayeredImage image(const std::vector<std::string>& channels, const std::vector<float>& values) {
    const int width = static_cast<int>(values.size() / channels.size());
    return {width, 1, {{"", channels, values, false}}, {}};
}

TEST(RgbMap, TakesColourOrLuminance) {
    const RgbMap colour = rgbMap(image({"A", "B", "G", "R"}, {1, 2, 3, 4, 5, 6, 7, -8}), "map");
    EXPECT_EQ(colour.pixels.at(0), Rgb(4, 3, 2));
    EXPECT_EQ(colour.pixels.at(1), Rgb(0, 7, 6));
    const RgbMap grey = rgbMap(image({"Y"}, {3}), "map");
    EXPECT_EQ(grey.pixels.at(0), Rgb(3, 3, 3));
}

TEST(RgbMap, RefusesWhatHasNoColours) {
    EXPECT_THROW(rgbMap(LayeredImage{1, 1, {{"N", {"X"}, {1}, false}}, {}}, "map"), Error);
    EXPECT_THROW(rgbMap(image({"R", "G"}, {1, 2}), "map"), Error);
    try {
        rgbMap(image({"Y"}, {1, std::nanf("")}), "map.exr");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("map.exr: pixel (1, 0)"), std::string::npos);
    }
}

}  // namespace
}  // namespace sss
