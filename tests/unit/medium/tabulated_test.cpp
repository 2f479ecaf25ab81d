#include "sss/medium/tabulated.h"

#include "sss/medium/half_space.h"
#include "sss/medium/photon_profile.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

using namespace sss;

namespace {

const ChannelMedium kMedium{0.05, 2, 0.3, 1.4};

class TabulatedTest : public ::testing::Test {
protected:
    TabulatedTest() {
        folder_ = std::filesystem::temp_directory_path() /
                  ("sss_tabulated_" + std::to_string(::getpid()));
        options_.tabulatedCacheFolder = folder_;
        options_.tabulatedError = 0.02;  // quick
    }
    ~TabulatedTest() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
    ProfileOptions options_;
};

TEST_F(TabulatedTest, TotalIsTheTransferTotalAndTheSimulationAgrees) {
    for (const Illumination illumination : {Illumination::Normal, Illumination::Diffuse}) {
        options_.tabulatedIllumination = illumination;
        const Tabulated profile(kMedium, options_);
        const HalfSpaceTotals totals = halfSpaceTotals(kMedium);
        const double truth = illumination == Illumination::Normal ? totals.normal : totals.diffuse;
        EXPECT_EQ(profile.total(), truth);
        EXPECT_NEAR(profile.simulatedTotal(), truth, 4 * profile.simulatedError());
        EXPECT_LE(profile.simulatedError(), 0.02 * truth);
        EXPECT_GT(profile.simulatedError(), 0);
        EXPECT_NEAR(profile.tail(0), profile.total(), 1e-9);
    }
}

TEST_F(TabulatedTest, DecreasesSmoothlyAndScales) {
    const Tabulated profile(kMedium, options_);
    EXPECT_TRUE(std::isinf(profile.reflectance(0)));
    double last = profile.reflectance(1e-6);
    for (double r = 1e-6; r < 200; r *= 1.05) {
        const double value = profile.reflectance(r);
        ASSERT_TRUE(std::isfinite(value) && value >= 0);
        ASSERT_LE(value, last * (1 + 1e-6)) << r;
        last = value;
    }
    const ChannelMedium denser{0.05 * 7, 2 * 7, 0.3, 1.4};
    const Tabulated other(denser, options_);
    for (const double r : {0.01, 0.5, 5.0}) {
        EXPECT_NEAR(other.reflectance(r / 7), 49 * profile.reflectance(r),
                    1e-9 * 49 * profile.reflectance(r));
    }
    const std::array<float, 3> radii{0.01f, 0.7f, 9.0f};
    std::array<float, 3> out{};
    profile.reflectance(radii, out);
    for (std::size_t i = 0; i < radii.size(); ++i) {
        const double expected = profile.reflectance(static_cast<double>(radii[i]));
        EXPECT_NEAR(static_cast<double>(out[i]), expected, 2e-6 * expected);
    }
}

TEST_F(TabulatedTest, RingsOfTheMarbleSimulation) {
    // Bin means per transmitted flux of an independent simulation, ground-truth.md section 4.
    options_.tabulatedIllumination = Illumination::Normal;
    options_.tabulatedError = 0.006;
    const Tabulated profile({0.0041, 2.62, 0, 1.5}, options_);
    struct Ring {
        double lo, hi, mean;
    };
    for (const Ring& ring :
         {Ring{0.1, 0.178, 0.4464}, Ring{0.316, 0.562, 0.10979}, Ring{1, 1.78, 0.021746},
          Ring{3.16, 5.62, 0.0015799}, Ring{10, 17.8, 2.5655e-5}}) {
        const double area = kPi * (ring.hi * ring.hi - ring.lo * ring.lo);
        const double mean = (profile.tail(ring.lo) - profile.tail(ring.hi)) / area;
        // The standard error that a ring is simulated to, five times that of the total.
        EXPECT_NEAR(mean, ring.mean, 0.03 * ring.mean) << ring.lo;
    }
}

TEST_F(TabulatedTest, IsReadBackFromTheFolderAndRemadeWhenDamaged) {
    const Tabulated first(kMedium, options_);
    std::filesystem::path file;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) file = entry.path();
    ASSERT_FALSE(file.empty());
    const auto written = std::filesystem::last_write_time(file);
    const Tabulated again(kMedium, options_);
    EXPECT_EQ(again.reflectance(0.3), first.reflectance(0.3));
    EXPECT_EQ(std::filesystem::last_write_time(file), written);
    {
        std::fstream damage(file, std::ios::in | std::ios::out);
        damage.seekp(80);
        damage.put('7');
        damage.put('7');
    }
    const Tabulated remade(kMedium, options_);
    EXPECT_EQ(remade.reflectance(0.3), first.reflectance(0.3));
    std::ofstream(file, std::ios::trunc) << "sss-photon-profile 1";
    EXPECT_EQ(Tabulated(kMedium, options_).total(), first.total());
}

TEST_F(TabulatedTest, AFolderThatCannotBeWrittenOnlyCostsTime) {
    std::ofstream(folder_) << "a file where the folder should be";
    const Tabulated profile(kMedium, options_);
    EXPECT_GT(profile.total(), 0.4);
}

TEST_F(TabulatedTest, ExtremesAreExact) {
    const Tabulated dark({1, 0, 0, 1.3}, options_);
    EXPECT_EQ(dark.total(), 0.0);
    EXPECT_EQ(dark.reflectance(0.0), 0.0);
    EXPECT_EQ(dark.tail(0.5), 0.0);
    PhotonProfileKey key;
    key.reducedAbsorption = 0;
    key.eta = 1.0;
    key.relativeError = 0.05;
    EXPECT_EQ(simulatePhotonProfile(key).total, 1.0);
}

}  // namespace
