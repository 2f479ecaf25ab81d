#include "sss/image/tone_map.h"

#include "sss/base/error.h"
#include "sss/base/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sss {
namespace {

LayeredImage constant(const Rgb& colour, int side) {
    LayeredImage image{side, side, {}, {}};
    ImageLayer layer{"", {"R", "G", "B", "A"}, {}, false};
    for (std::size_t i = 0; i < image.pixelCount(); ++i)
        layer.values.insert(layer.values.end(), {colour.x, colour.y, colour.z, 1.0f});
    image.layers.push_back(layer);
    return image;
}

TEST(ToneMap, DarkAndMiddleTonesPassUnchanged) {
    for (const float v : {0.0f, 1e-6f, 0.18f, 0.5f, 0.8f})
        EXPECT_EQ(toneMapped({v, 0.5f * v, 0.25f * v}), Rgb(v, 0.5f * v, 0.25f * v));
}

TEST(ToneMap, NeverDecreasesWithExposureAndStaysInRange) {
    Rng rng(1);
    for (int colour = 0; colour < 200; ++colour) {
        const Rgb hue{rng.uniform(), rng.uniform(), rng.uniform()};
        Rgb before{0.0f};
        for (float gain = 0.01f; gain < 1e6f; gain *= 1.05f) {
            const Rgb shown = toneMapped(gain * hue);
            for (int c = 0; c < 3; ++c) {
                ASSERT_GE(shown[c], before[c] - 2e-7f);
                ASSERT_LE(shown[c], 1.0f);
            }
            before = shown;
        }
        EXPECT_GT(before.x + before.y + before.z, 2.9f);  // far over the top is white
    }
}

TEST(ToneMap, ShoulderIsSmooth) {
    // Slope 1 on both sides of the joint.
    const float h = 1e-3f;
    const float above = (toneMapped(Rgb{0.8f + h}).x - toneMapped(Rgb{0.8f}).x) / h;
    EXPECT_NEAR(above, 1.0f, 0.01f);
    EXPECT_NEAR(toneMapped(Rgb{1.0f}).x, 0.9f, 1e-5f);
}

TEST(ToneMap, HueStays) {
    // (mid - min) / (max - min) fixes the hue.
    const Rgb colour{3.0f, 1.5f, 0.6f};
    const Rgb shown = toneMapped(colour);
    EXPECT_NEAR((shown.y - shown.z) / (shown.x - shown.z),
                (colour.y - colour.z) / (colour.x - colour.z), 1e-5f);
}

TEST(ToneMap, NonsenseIsBlack) {
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(toneMapped({std::nanf(""), -1.0f, 0.0f}), Rgb(0.0f));
    EXPECT_NEAR(toneMapped(Rgb{infinity}).x, 1.0f, 1e-6f);
}

TEST(ToneMap, SrgbCurveMatchesTheStandard) {
    EXPECT_EQ(srgbEncoded(0), 0);
    EXPECT_NEAR(srgbEncoded(1), 1, 1e-6f);
    EXPECT_NEAR(srgbEncoded(0.214041f), 0.5f, 1e-5f);       // code 0.5 decodes to 0.21404
    EXPECT_NEAR(srgbEncoded(0.0031308f), 0.04045f, 1e-5f);  // the joint
}

TEST(ToneMap, DitherKeepsTheMeanAndNeverMovesByACode) {
    const float linear = 0.05f;
    const float code = srgbEncoded(linear) * 255.0f;
    const Picture8 picture = toneMap(constant(Rgb{linear}, 64), 0);
    ASSERT_EQ(picture.values.size(), 64u * 64u * 3u);
    double sum = 0;
    for (const std::uint8_t value : picture.values) {
        EXPECT_LT(std::abs(static_cast<float>(value) - code), 1.0f);
        sum += value;
    }
    EXPECT_NEAR(sum / static_cast<double>(picture.values.size()), static_cast<double>(code), 0.01);
}

TEST(ToneMap, BlackIsBlackAndWhiteIsWhite) {
    for (const std::uint8_t value : toneMap(constant(Rgb{0.0f}, 16), 3).values) EXPECT_EQ(value, 0);
    for (const std::uint8_t value : toneMap(constant(Rgb{1.0f}, 16), 20).values)
        EXPECT_EQ(value, 255);
}

TEST(ToneMap, StopsDouble) {
    EXPECT_EQ(toneMap(constant(Rgb{0.1f}, 8), 2).values, toneMap(constant(Rgb{0.4f}, 8), 0).values);
    EXPECT_THROW(toneMap(LayeredImage{}, 0), Error);
}

}  // namespace
}  // namespace sss
