#include "sss/light/environment_light.h"

#include "sss/base/error.h"
#include "sss/base/rng.h"
#include "sss/image/exr_file.h"
#include "support/temporary_folder.h"
#include "unit/light/light_checks.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::expectDistributed;
using testing::expectSeenAgrees;
using testing::irradiance;

/// Random, with a sun 10000 times brighter than the rest and a dark quarter.
RgbMap sunnyMap() {
    RgbMap map{32, 16, {}};
    Rng rng(31);
    for (int i = 0; i < 32 * 16; ++i)
        map.pixels.push_back(i % 32 < 8 ? Rgb{0.0f} : Rgb{rng.uniform(), rng.uniform(), 1});
    map.pixels[5 * 32 + 20] = Rgb{1e4f};
    return map;
}

TEST(Environment, ConstantGivesPiTimesRadiance) {
    const ConstantEnvironment light({2, 1, 0});
    EXPECT_NEAR(irradiance(light, {}, {0, 1, 0}), 2 * kPi, 2e-3);
    EXPECT_NEAR(irradiance(light, {}, glm::normalize(Vec3{1, -2, 3})), 2 * kPi, 1e-2);
    EXPECT_NEAR(light.importance({}), kPi, 1e-5);
    EXPECT_TRUE(light.isInfinite());
    EXPECT_FALSE(light.isDelta());
    expectSeenAgrees(light, {1, 2, 3});
}

TEST(Environment, ConstantMapIsAConstant) {
    const MapEnvironment light({8, 4, std::vector<Rgb>(32, Rgb{1.0f})}, {2, 2, 2}, 77);
    EXPECT_NEAR(irradiance(light, {}, {0, 1, 0}), 2 * kPi, 4e-3);
    EXPECT_NEAR(irradiance(light, {}, {1, 0, 0}), 2 * kPi, 4e-3);
    EXPECT_NEAR(light.importance({}), 2 * kPi, 1e-5);
}

TEST(Environment, MapLiesAsOpenExrSays) {
    // Middle of the picture: +z; middle of its left half: +x; top row: +y.
    RgbMap map{64, 32, std::vector<Rgb>(64 * 32, Rgb{0.0f})};
    for (int y = 14; y < 18; ++y)
        for (int x = 0; x < 64; ++x) {
            Rgb& pixel = map.pixels[static_cast<std::size_t>(y * 64 + x)];
            if (std::abs(x - 31.5) < 3) pixel = {1, 0, 0};
            if (std::abs(x - 15.5) < 3) pixel = {0, 1, 0};
        }
    for (std::size_t x = 0; x < 128; ++x) map.pixels[x] = {0, 0, 1};
    const MapEnvironment light(map, Rgb{1.0f}, 0);
    EXPECT_EQ(light.seen({}, {0, 0, 1}).radiance, Rgb(1, 0, 0));
    EXPECT_EQ(light.seen({}, {1, 0, 0}).radiance, Rgb(0, 1, 0));
    EXPECT_EQ(light.seen({}, {0, 1, 0}).radiance, Rgb(0, 0, 1));
    EXPECT_EQ(light.seen({}, {0, -1, 0}).radiance, Rgb(0.0f));
    // A quarter turn takes what was at +z to +x.
    const MapEnvironment turned(map, Rgb{1.0f}, 90);
    EXPECT_EQ(turned.seen({}, {1, 0, 0}).radiance, Rgb(1, 0, 0));
    EXPECT_EQ(turned.seen({}, {0, 0, -1}).radiance, Rgb(0, 1, 0));
}

TEST(Environment, SeenAgreesWithSamples) {
    for (const double rotation : {0.0, 123.0, -400.0}) {
        // The density jumps between pixels: rays of rounded directions near an edge may fall in the
        // next one, so compare pixel by pixel only where the jump is small.
        RgbMap smooth{64, 32, {}};
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x)
                smooth.pixels.push_back(Rgb{1.5f + std::sin(static_cast<float>(x) * 0.098f),
                                            2.0f + 0.01f * static_cast<float>(y), 1});
        expectSeenAgrees(MapEnvironment(smooth, Rgb{1.0f}, rotation), {}, 0.15f);
    }
    const MapEnvironment sunny(sunnyMap(), Rgb{1.0f}, 40);
    int different = 0;
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const LightSample s = sunny.sample({}, Sampler(4, i).next2D());
        const Light::Seen seen = sunny.seen({}, s.direction);
        if (std::abs(seen.pdf - s.pdf) > 1e-3f * s.pdf) ++different;
        EXPECT_NEAR(seen.radiance.x, s.radiance.x, 1e-3f * s.radiance.x + 0.05f);
    }
    EXPECT_LT(different, 5);
}

/// Unit vector at an angle from +y and a longitude from +z to +x.
Vec3 direction(double theta, double longitude) {
    return Vec3(DVec3{std::sin(theta) * std::sin(longitude), std::cos(theta),
                      std::sin(theta) * std::cos(longitude)});
}

TEST(Environment, DensityIntegratesToOneAndSamplesFollowIt) {
    // Turned by two pixels, so that the cells of the quadrature end where the pixels do.
    const MapEnvironment light(sunnyMap(), Rgb{1.0f}, 22.5);
    const int rows = 8, columns = 16, fine = 32, n = 60000;
    const double stepTheta = kPi / (rows * fine), stepLongitude = 2 * kPi / (columns * fine);
    std::vector<double> expected(rows * columns, 0.0), counts(rows * columns, 0.0);
    double total = 0;
    for (int i = 0; i < rows * fine; ++i)
        for (int j = 0; j < columns * fine; ++j) {
            const double theta = (i + 0.5) * stepTheta;
            const Vec3 d = direction(theta, (j + 0.5) * stepLongitude);
            const double mass = static_cast<double>(light.seen({}, d).pdf) * std::sin(theta) *
                                stepTheta * stepLongitude;
            total += mass;
            expected[static_cast<std::size_t>(i / fine * columns + j / fine)] += n * mass;
        }
    EXPECT_NEAR(total, 1, 1e-3);
    Rng rng(90);
    for (int s = 0; s < n; ++s) {
        const DVec3 d(light.sample({}, rng.uniform2()).direction);
        double turn = std::atan2(d.x, d.z) / (2 * kPi);
        if (turn < 0) turn += 1;
        const int i = std::min(rows - 1, static_cast<int>(std::acos(d.y) / kPi * rows));
        const int j = std::min(columns - 1, static_cast<int>(turn * columns));
        ++counts[static_cast<std::size_t>(i * columns + j)];
    }
    expectDistributed(counts, expected);
}

TEST(Environment, MapIrradianceMatchesQuadrature) {
    const MapEnvironment light(sunnyMap(), Rgb{1.0f}, 25);
    const Vec3 normal = glm::normalize(Vec3{1, 2, -0.5f});
    double expected = 0;
    const int rows = 1000, columns = 2000;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double cosine = 1 - 2 * (i + 0.5) / rows;
            const double angle = 2 * kPi * (j + 0.5) / columns;
            const double sine = std::sqrt(1 - cosine * cosine);
            const Vec3 d(DVec3{sine * std::cos(angle), cosine, sine * std::sin(angle)});
            const float facing = glm::dot(d, normal);
            if (facing > 0) expected += static_cast<double>(light.seen({}, d).radiance.x * facing);
        }
    expected *= 4 * kPi / (rows * static_cast<double>(columns));
    EXPECT_NEAR(irradiance(light, {}, normal), expected, 0.01 * expected);
}

TEST(Environment, BlackMapIsNoLightButNoTrouble) {
    const MapEnvironment light({4, 2, std::vector<Rgb>(8, Rgb{0.0f})}, Rgb{1.0f}, 0);
    const LightSample s = light.sample({}, {0.3f, 0.6f});
    EXPECT_EQ(s.radiance, Rgb(0.0f));
    EXPECT_TRUE(std::isfinite(s.pdf));
    EXPECT_EQ(light.importance({}), 0);
}

TEST(Environment, MapsComeFromFiles) {
    const testing::TemporaryFolder folder;
    LayeredImage image{2, 1, {{"", {"Y"}, {3, 3}, true}}, {}};
    writeExr(folder / "sky.exr", image);
    const auto light = makeEnvironment({{1, 2, 3}, folder / "sky.exr", 0});
    EXPECT_EQ(light->seen({}, {0, 0, 1}).radiance, Rgb(3, 6, 9));
    EXPECT_THROW(makeEnvironment({{1, 1, 1}, folder / "none.exr", 0}), Error);
}

}  // namespace
}  // namespace sss
