// Profiles that diverge at r = 0, averaged over a sample's own area: nothing is lost or won, and
// r = 0 is finite.
#include "sss/base/vec.h"
#include "sss/cloud/kernel_table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

namespace sss {
namespace {

class Regularise : public ::testing::Test {
protected:
    Regularise() {
        options_.tabulatedCacheFolder =
            std::filesystem::temp_directory_path() / ("sss_regularise_" + std::to_string(getpid()));
        options_.tabulatedError = 0.02;
    }
    ~Regularise() override { std::filesystem::remove_all(options_.tabulatedCacheFolder); }

    std::unique_ptr<Profile> make(std::string_view name) const {
        return makeProfile(name, {0.0041, 2.62, 0, 1.5}, options_);
    }
    ProfileOptions options_;
};

constexpr std::string_view kSingular[] = {
    "normalized_diffusion",      "normalized_diffusion_perpendicular",
    "normalized_diffusion_dmfp", "photon_beam",
    "photon_beam_single",        "tabulated"};

// Integral of 2 pi r R r dr over [0, 5 a], where the singularity has been spread.
double regularisedWithin(const Profile& profile, double a) {
    const RegularisedProfile regularised(profile, a);
    double sum = 0;
    const double edges[] = {0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5};
    for (std::size_t i = 0; i + 1 < std::size(edges); ++i) {
        constexpr int kSteps = 24;
        const double h = (edges[i + 1] - edges[i]) * a / kSteps;
        for (int k = 0; k < kSteps; ++k) {
            const double r = edges[i] * a + (k + 0.5) * h;
            sum += 2 * kPi * r * regularised(r) * h;
        }
    }
    return sum;
}

TEST_F(Regularise, KeepsTheTotal) {
    for (const std::string_view name : kSingular) {
        const auto profile = make(name);
        for (const double cellInPaths : {0.01, 0.05, 0.2, 0.4}) {
            SCOPED_TRACE(std::string(name) + " " + std::to_string(cellInPaths));
            const double a = cellInPaths / 2.6241;
            const double total = regularisedWithin(*profile, a) + profile->tail(5 * a);
            EXPECT_NEAR(total, profile->total(), 1e-4 * profile->total());
        }
    }
}

TEST_F(Regularise, IsFiniteAtZeroAndTheProfileFurtherOut) {
    for (const std::string_view name : kSingular) {
        SCOPED_TRACE(name);
        const auto profile = make(name);
        const double a = 0.05 / 2.6241;
        const double mean = profile->cumulative(a) / (kPi * a * a);
        // The mean over the disk, but for what keeps the total.
        const RegularisedProfile regularised(*profile, a);
        EXPECT_NEAR(regularised(0), mean, 0.03 * mean);
        EXPECT_GT(regularised(0), profile->reflectance(a));
        // Decreasing, and the profile itself further out.
        double last = regularised(0);
        for (double r = 0.01 * a; r < 5 * a; r *= 1.2) {
            const double value = regularised(r);
            EXPECT_LE(value, last * (1 + 2e-3)) << r / a;
            last = value;
        }
        EXPECT_EQ(regularised(5 * a), profile->reflectance(5 * a));
    }
}

// A plane of samples, seen from one of them and from between four of them: the sum comes to the
// total as the spacing shrinks.
TEST_F(Regularise, SumsOfSamplesConvergeToTheTotal) {
    const auto profile = make("photon_beam");
    const double path = 1 / 2.6241;
    const double reach = 12 * path;
    const double expected = profile->total() - profile->tail(reach);
    for (const double offset : {0.0, 0.5}) {
        double lastError = 1;
        for (const double spacing : {0.4 * path, 0.2 * path}) {
            const double a = spacing / std::sqrt(kPi);
            const KernelTable table({profile.get(), profile.get(), profile.get()}, 2 * reach, a);
            const int n = static_cast<int>(reach / spacing) + 1;
            double sum = 0;
            for (int i = -n; i <= n; ++i)
                for (int k = -n; k <= n; ++k) {
                    const double x = (i + offset) * spacing, y = (k + offset) * spacing;
                    if (x * x + y * y > reach * reach) continue;
                    const auto u = static_cast<float>(x * x + y * y);
                    sum += static_cast<double>(table.evaluate(u).x) * spacing * spacing;
                }
            const double error = std::abs(sum / expected - 1);
            EXPECT_LT(error, spacing < 0.3 * path ? 0.01 : 0.03) << offset << " " << spacing / path;
            EXPECT_LT(error, lastError + 2e-3);
            lastError = error;
        }
    }
}

}  // namespace
}  // namespace sss
