// Radii, coefficients and slabs at the ends of what numbers hold: never a NaN, and still right.
#include "sss/base/error.h"
#include "sss/medium/profile.h"
#include "sss/optics/gauss_legendre.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

using namespace sss;

namespace {

const std::vector<std::string> kEveryModel{
    "dipole",
    "better_dipole",
    "normalized_diffusion",
    "normalized_diffusion_perpendicular",
    "normalized_diffusion_dmfp",
    "multipole",
    "multipole_transmittance",
    "photon_beam",
    "photon_beam_single",
};

const ChannelMedium kMarble{0.0041, 2.62, 0, 1.5};

std::unique_ptr<Profile> extremeProfile(const std::string& model, ChannelMedium medium,
                                        double thickness) {
    ProfileOptions options;
    if (model.starts_with("multipole")) options.slabThicknessMm = thickness;
    if (model == "normalized_diffusion_dmfp" && medium.sigmaA == 0) medium.sigmaA = 1e-320;
    return makeProfile(model, medium, options);
}

/// Numbers at every radius that a double holds: R_d decreasing, what lies inside increasing. R_d
/// may be infinite where 1/r is.
void expectNumbersAtEveryRadius(const Profile& profile, const std::string& where) {
    double lastValue = std::numeric_limits<double>::infinity(), lastInside = 0;
    for (double r = 5e-324; std::isfinite(r); r = std::max(r * 1e7, 1e-320)) {
        SCOPED_TRACE(where + " r " + std::to_string(std::log10(r)));
        const double value = profile.reflectance(r);
        EXPECT_TRUE(value >= 0 && value <= lastValue * (1 + 1e-12)) << value;
        EXPECT_TRUE(std::isfinite(value) || (profile.singularAtZero() && r < 1e-200)) << value;
        const double inside = profile.cumulative(r);
        EXPECT_TRUE(inside >= lastInside * (1 - 1e-8) && inside <= profile.total() * (1 + 1e-8))
            << inside << " after " << lastInside;
        const double tail = profile.tail(r);
        EXPECT_NEAR(tail + inside, profile.total(), 1e-8 * profile.total() + 1e-300);
        lastValue = value;
        lastInside = inside;
    }
    EXPECT_NEAR(lastInside, profile.total(), 1e-8 * profile.total());
}

TEST(Extremes, EveryRadiusGivesNumbers) {
    for (const std::string& model : kEveryModel) {
        for (const ChannelMedium& medium :
             {kMarble, ChannelMedium{0, 1e-6, 0, 1.3}, ChannelMedium{1e-200, 1e6, -0.99, 0.75},
              ChannelMedium{1e-40, 1e-40, 0, 1}, ChannelMedium{1e40, 1e42, 0.999, 3},
              ChannelMedium{5e-324, 1, 0, 1.3}, ChannelMedium{1, 1e-250, 0, 1.3}}) {
            expectNumbersAtEveryRadius(*extremeProfile(model, medium, 3 * medium.meanFreePathMm()),
                                       model + " " + std::to_string(std::log10(medium.sigmaA)));
        }
    }
}

TEST(Extremes, TheSimulatedProfileToo) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("sss_extremes_" + std::to_string(::getpid()));
    ProfileOptions options;
    options.tabulatedCacheFolder = folder;
    options.tabulatedError = 0.1;  // quick
    for (const ChannelMedium& medium : {ChannelMedium{0, 1e-6, 0, 1.3}, ChannelMedium{1, 2, 0, 1}})
        expectNumbersAtEveryRadius(*makeProfile("tabulated", medium, options), "tabulated");
    std::filesystem::remove_all(folder);
}

TEST(Extremes, LawsAtTheSingularityGoOnToTheSmallestRadii) {
    const auto multiple = makeProfile("photon_beam", kMarble);
    const auto at = [&](double r) { return multiple->reflectance(r); };
    // a - b log r
    const double perDecade = (at(1e-30) - at(1e-20)) / 10;
    EXPECT_NEAR(at(1e-155), at(1e-30) + 125 * perDecade, 1e-9 * at(1e-155));
    EXPECT_NEAR(at(1e-300), at(1e-30) + 270 * perDecade, 1e-9 * at(1e-300));
    const auto single = makeProfile("photon_beam_single", kMarble);
    EXPECT_NEAR(1e-200 * single->reflectance(1e-200), 1e-20 * single->reflectance(1e-20), 1e-9);
}

TEST(Extremes, CumulativeIsTheQuadratureOfTheProfile) {
    for (const std::string& model : kEveryModel) {
        const auto profile = extremeProfile(model, kMarble, 1.0);
        double sum = 0, lo = 0;
        for (double r = 1e-9; r < 30; r *= 1.7) {
            const auto ring = [&](double x) { return 2 * kPi * x * profile->reflectance(x); };
            // From 0, halving towards it.
            if (lo == 0)
                for (double hi = r; hi > 1e-10 * r; hi *= 0.5) sum += gauss16(0.5 * hi, hi, ring);
            else
                sum += gauss16(lo, r, ring);
            lo = r;
            EXPECT_NEAR(profile->cumulative(r), sum, 2e-8 * sum) << model << " r " << r;
        }
    }
}

// Slabs whose source lies far below a mean free path from the face: nothing is flat there.
TEST(Extremes, CumulativeOfThinSlabsIsSmooth) {
    struct Slab {
        const char* model;
        double thickness;
    };
    for (const Slab& slab :
         {Slab{"multipole_transmittance", 1.0001}, Slab{"multipole_transmittance", 1 + 1e-9},
          Slab{"multipole", 1e-3}, Slab{"multipole", 1e-6}, Slab{"multipole", 1.0}}) {
        const auto profile = extremeProfile(slab.model, {0.1, 0.9, 0, 1.3}, slab.thickness);
        double last = profile->cumulative(1e-12);
        for (double r = 1e-12; r < 100;) {
            // Of a decreasing R_d the integral grows at most like the area.
            r *= 1.1;
            const double inside = profile->cumulative(r);
            EXPECT_GE(inside, last * (1 - 1e-12)) << slab.model << slab.thickness << " r " << r;
            EXPECT_LE(inside, last * 1.21 * (1 + 1e-10))
                << slab.model << slab.thickness << " r " << r;
            last = inside;
        }
        EXPECT_NEAR(last, profile->total(), 1e-9);
    }
}

TEST(Extremes, LengthsOutsideAreRefusedInWords) {
    const auto refused = [](const std::string& model, const ChannelMedium& medium, double thickness,
                            const std::string& words) {
        try {
            extremeProfile(model, medium, thickness);
            ADD_FAILURE() << model;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::BadInput);
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    };
    refused("dipole", {1e-200, 1e-200, 0, 1.3}, 1, "mean free path of 5e+199 mm");
    refused("photon_beam", {1e-320, 0, 0, 1.3}, 1, "mean free path of inf mm");
    refused("better_dipole", {1e60, 1e60, 0, 1.3}, 1, "mean free path of 5e-61 mm");
    refused("multipole", kMarble, 1e-60, "thickness of 1e-60 mm");
    EXPECT_EQ(makeProfile("dipole", {0, 0, 0, 1.3})->total(), 0.0);
}

}  // namespace
