#include "sss/light/volume_light.h"

#include "unit/light/light_checks.h"
#include "unit/volume/volume_tools.h"

#include <array>

namespace sss {
namespace {

using namespace testing;

class VolumeLightTest : public ::testing::Test {
protected:
    VolumeLightTest() {
        VolumeSettings settings = greyVolume(0.5f, 0, 6);
        settings.grid =
            writeGrid(folder_.path() / "a.raw", {4, 3, 5}, 4, [](const DVec3& p, int channel) {
                return static_cast<float>(channel == 0 ? 1 : p.x * p.y + channel * p.z);
            });
        VolumePlace place;
        place.worldFromUnit = glm::translate(DMat4(1.0), {-1, 0, 2}) *
                              glm::rotate(DMat4(1.0), 0.5, {0, 0, 1}) *
                              glm::scale(DMat4(1.0), {3, 2, 1});
        volume_.emplace(settings, place);
        light_.emplace(*volume_, 7);
    }
    TemporaryFolder folder_;
    std::optional<Volume> volume_;
    std::optional<VolumeLight> light_;
};

// Directions come as often as the density says: counts in bins of the sphere, from outside and in.
TEST_F(VolumeLightTest, SamplesByItsDensity) {
    constexpr int kZ = 12, kPhi = 24;
    constexpr std::uint32_t kCount = 1 << 15, kFine = 12;
    for (const Vec3& from : {Vec3(2, -0.5f, 1.2f), Vec3(0.2f, 1, 2.5f)}) {
        std::vector<double> counts(kZ * kPhi, 0), expected(kZ * kPhi, 0);
        for (std::uint32_t i = 0; i < kCount; ++i) {
            const LightSample s = light_->sample(from, Sampler(3, i).next2D());
            ASSERT_NEAR(s.pdf, light_->pdf(from, s.direction), 1e-4f * s.pdf);
            const float phi = std::atan2(s.direction.y, s.direction.x) / (2 * kPiF) + 0.5f;
            const int z = std::clamp(static_cast<int>((s.direction.z + 1) / 2 * kZ), 0, kZ - 1);
            counts[static_cast<std::size_t>(
                z * kPhi + std::clamp(static_cast<int>(phi * kPhi), 0, kPhi - 1))] += 1;
        }
        double total = 0;
        for (std::uint32_t i = 0; i < kZ * kFine; ++i)
            for (std::uint32_t j = 0; j < kPhi * kFine; ++j) {
                const float z = 2 * (static_cast<float>(i) + 0.5f) / (kZ * kFine) - 1;
                const float phi =
                    2 * kPiF * ((static_cast<float>(j) + 0.5f) / (kPhi * kFine) - 0.5f);
                const float r = std::sqrt(1 - z * z);
                const double share =
                    double(light_->pdf(from, {r * std::cos(phi), r * std::sin(phi), z})) * 4 * kPi /
                    (kZ * kFine * kPhi * kFine);
                expected[i / kFine * kPhi + j / kFine] += share * kCount;
                total += share;
            }
        EXPECT_NEAR(total, 1, 2e-3);
        std::vector<double> some, wanted;
        for (std::size_t b = 0; b < counts.size(); ++b) {
            if (expected[b] < 40) continue;  // the quadrature of small bins is rough
            some.push_back(counts[b]);
            wanted.push_back(expected[b]);
        }
        ASSERT_GT(some.size(), 15u);
        expectDistributed(some, wanted);
    }
}

// Far away it is a point of the intensity integral of j.
TEST_F(VolumeLightTest, ShinesByWhatItEmits) {
    EXPECT_EQ(light_->volume(), 7);
    EXPECT_FALSE(light_->isDelta());
    // The mean over the channels of xy + c z over the cube is 1/4 + 2/2.
    const double intensity = 0.5 * 6 * 6 * 1.25;
    Bounds target;
    target.add(Vec3(1000, 0, 0));
    const Vec3 centre = *light_->centre();
    const double distance2 = glm::dot(target.lo - centre, target.lo - centre);
    EXPECT_NEAR(light_->importance(target), intensity / distance2, 1e-4 * intensity / distance2);
    EXPECT_TRUE(light_->isBelow({0, 0, 3.5f}, {0, 0, 1}));
    EXPECT_FALSE(light_->isBelow({0, 0, 2.5f}, {0, 0, 1}));
}

}  // namespace
}  // namespace sss
