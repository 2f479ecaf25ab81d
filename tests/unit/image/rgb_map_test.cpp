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
    const std::pair<LayeredImage, const char*> refused[] = {
        {LayeredImage{1, 1, {{"N", {"X"}, {1}, false}}, {}}, "a.exr: has no plain colour channels"},
        {image({"R", "G"}, {1, 2}), "a.exr: has neither channels R, G and B nor channel Y"},
        {image({"Y"}, {1, std::nanf("")}), "a.exr: pixel (1, 0) is not finite"}};
    for (const auto& [picture, words] : refused) {
        try {
            rgbMap(picture, "a.exr");
            ADD_FAILURE() << "accepted where it should have said: " << words;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace sss
