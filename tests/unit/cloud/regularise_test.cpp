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
        // The mean over a disk as large as the cell, but for what keeps the total.
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

/// Samples in a square grid on a plane, evenly lit, out to `reach`.
struct Plane {
    const Profile& profile;
    double reach, spacing;
    KernelTable table{{&profile, &profile, &profile}, 2 * reach, spacing / std::sqrt(kPi)};

    /// Sum over all within reach, of the total within it, less 1; seen from (offset, offset)
    /// spacings beside a sample.
    double error(double offset) const {
        const int n = static_cast<int>(reach / spacing) + 1;
        double sum = 0;
        for (int i = -n; i <= n; ++i)
            for (int k = -n; k <= n; ++k) {
                const double x = (i + offset) * spacing, y = (k + offset) * spacing;
                if (x * x + y * y > reach * reach) continue;
                const auto u = static_cast<float>(x * x + y * y);
                sum += static_cast<double>(table.evaluate(u).x) * spacing * spacing;
            }
        return sum / (profile.total() - profile.tail(reach)) - 1;
    }
};

// From a sample and from between four: the sum comes to the total as the spacing shrinks.
TEST_F(Regularise, SumsOfSamplesConvergeToTheTotal) {
    const double path = 1 / 2.6241;
    for (const auto& [name, most] :
         {std::pair{"photon_beam", 0.003}, {"normalized_diffusion", 0.015}}) {
        const auto profile = make(name);
        for (const double offset : {0.0, 0.5}) {
            const double coarse = Plane{*profile, 12 * path, 0.4 * path}.error(offset);
            const double fine = Plane{*profile, 12 * path, 0.2 * path}.error(offset);
            SCOPED_TRACE(std::string(name) + " " + std::to_string(offset));
            EXPECT_LT(std::abs(coarse), most);
            EXPECT_LT(std::abs(fine), most / 2);
            EXPECT_LT(std::abs(fine), std::abs(coarse) + 2e-3);
        }
    }
}

}  // namespace
}  // namespace sss
