#include "sss/image/flip.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace sss {
namespace {

constexpr int kWidth = 40, kHeight = 28;

ImageLayer colours(const auto& colourAt) {
    ImageLayer layer{"", {"R", "G", "B"}, {}, false};
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (const double c : colourAt(x, y)) layer.values.push_back(static_cast<float>(c));
    return layer;
}

using Colour = std::array<double, 3>;
Colour reference(int x, int y) {
    const double wave = 0.5 + 0.5 * std::sin(0.7 * x + 0.3 * y);
    return {0.1 + 0.8 * x / kWidth, 0.6 * wave, (x / 7 + y / 5) % 2 ? 0.9 : 0.15};
}
Colour changed(int x, int y) {
    const auto [r, g, b] = reference(x, y);
    const bool isSpot = std::abs(x - 12) + std::abs(y - 14) <= 4;
    return {std::min(1.0, r * 1.1 + (x > 20 && y < 9 ? 0.2 : 0.0)), g * 0.8 + 0.05,
            isSpot ? 0.5 : b};
}

// The authors' own flip-evaluator 1.7 from PyPI: evaluate(..., "LDR", inputsRGB=False).
TEST(Flip, IsThatOfItsAuthors) {
    const std::vector<double> map = flipMap(colours(changed), colours(reference), kWidth);
    double mean = 0;
    for (const double v : map) mean += v / static_cast<double>(map.size());
    EXPECT_NEAR(mean, 0.248557, 2e-5);
    struct Pixel {
        int x, y;
        double flip;
    };
    for (const Pixel& p : {Pixel{0, 0, 0.222788}, Pixel{12, 14, 0.155202}, Pixel{25, 4, 0.399384},
                           Pixel{39, 27, 0.237450}, Pixel{20, 9, 0.218394}})
        EXPECT_NEAR(map[static_cast<std::size_t>(p.y * kWidth + p.x)], p.flip, 1e-4)
            << p.x << ' ' << p.y;
}

TEST(Flip, MeanUnderAMaskAtTheExposureOfTheReference) {
    const ImageLayer a = colours(changed), b = colours(reference);
    EXPECT_EQ(meanFlip(b, b, kWidth), 0);
    const double plain = meanFlip(a, b, kWidth);
    EXPECT_GT(plain, 0.05);
    ImageLayer brightA = a, brightB = b;
    for (float& v : brightA.values) v *= 1024;
    for (float& v : brightB.values) v *= 1024;
    EXPECT_NEAR(meanFlip(brightA, brightB, kWidth), plain, 1e-6);

    ImageLayer mask{"m", {"m"}, std::vector<float>(kWidth * kHeight, 0.0f), false};
    EXPECT_EQ(meanFlip(a, b, kWidth, &mask), 0);
    // A picture that differs far from the mask looks the same there.
    ImageLayer far = b;
    far.values[0] += 0.5f;
    mask.values.back() = 1;
    EXPECT_EQ(meanFlip(far, b, kWidth, &mask), 0);
    EXPECT_GT(meanFlip(far, b, kWidth), 0);
    far.values[0] = std::nanf("");
    EXPECT_TRUE(std::isnan(meanFlip(far, b, kWidth)));
}

}  // namespace
}  // namespace sss
