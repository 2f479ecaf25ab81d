// What every profile must hold, on thousands of random media.
#include "sss/medium/profile.h"

#include "random_media.h"
#include "sss/base/error.h"
#include "sss/medium/energy.h"
#include "sss/optics/gauss_legendre.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace sss;
using sss::test::describe;
using sss::test::RandomMedia;

namespace {

struct Subject {
    std::string name;
    int media;          ///< random media per run
    double quadrature;  ///< tolerance of total against the integral of the profile
};

/// All but the simulated one, which has its own test.
const std::vector<Subject>& subjects() {
    static const std::vector<Subject> all{
        {"dipole", 2000, 1e-9},
        {"better_dipole", 2000, 1e-9},
        {"normalized_diffusion", 1000, 1e-9},
        {"normalized_diffusion_perpendicular", 1000, 1e-9},
        {"normalized_diffusion_dmfp", 1000, 1e-9},
        {"multipole", 60, 1e-8},
        {"multipole_transmittance", 60, 1e-8},
        {"photon_beam", 15, 1e-7},
        {"photon_beam_single", 15, 1e-7},
    };
    return all;
}

std::unique_ptr<Profile> make(const std::string& name, ChannelMedium medium, double thickness) {
    ProfileOptions options;
    options.slabThicknessMm = thickness;
    if (name == "normalized_diffusion_dmfp" && medium.sigmaA == 0) {
        medium.sigmaA = 1e-9 * medium.sigmaTPrime();
    }
    return makeProfile(name, medium, options);
}

std::array<double, 10> radii(double scale) {
    std::array<double, 10> r{};
    for (std::size_t i = 0; i < r.size(); ++i) {
        r[i] = scale * 1e-4 * std::pow(10.0, 0.75 * static_cast<double>(i));
    }
    return r;
}

TEST(Profile, FiniteNonNegativeDecreasingAndAtMostOne) {
    for (const Subject& subject : subjects()) {
        RandomMedia media(11);
        for (int i = 0; i < subject.media; ++i) {
            const ChannelMedium medium = media.next();
            const auto profile =
                make(subject.name, medium, media.between(0.3, 30) * medium.meanFreePathMm());
            const std::string where = subject.name + ": " + describe(medium);
            ASSERT_GE(profile->total(), 0.0) << where;
            ASSERT_LE(profile->total(), 1.0) << where;
            double last = profile->reflectance(0.0);
            ASSERT_EQ(std::isinf(last), profile->singularAtZero()) << where;
            double lastTail = profile->tail(0.0);
            ASSERT_NEAR(lastTail, profile->total(), 1e-12) << where;
            for (const double r : radii(profile->scaleMm())) {
                const double value = profile->reflectance(r);
                ASSERT_TRUE(std::isfinite(value)) << where << " r " << r;
                ASSERT_GE(value, 0.0) << where << " r " << r;
                // An ulp of slack: far below the mean free path the profile is flat.
                ASSERT_LE(value, last * (1 + 1e-13)) << where << " r " << r;
                const double tail = profile->tail(r);
                ASSERT_TRUE(tail >= 0 && tail <= lastTail * (1 + 1e-11) + 1e-15)
                    << where << " r " << r << " tail " << tail << " after " << lastTail;
                last = value;
                lastTail = tail;
            }
        }
    }
}

TEST(Profile, TailIsTheQuadratureOfTheProfile) {
    for (const Subject& subject : subjects()) {
        RandomMedia media(12);
        for (int i = 0; i < std::min(subject.media, 12); ++i) {
            const ChannelMedium medium = media.next();
            const auto profile =
                make(subject.name, medium, media.between(1.5, 30) * medium.meanFreePathMm());
            double lo = 1e-7 * profile->scaleMm();
            double sum = profile->total() - profile->tail(lo);
            for (int k = 0; k < 100; ++k) {
                const double hi = lo * 1.3;
                sum += gauss16(lo, hi,
                               [&](double r) { return 2 * kPi * r * profile->reflectance(r); });
                lo = hi;
            }
            EXPECT_NEAR(sum + profile->tail(lo), profile->total(),
                        subject.quadrature * profile->total() + 1e-15)
                << subject.name << ": " << describe(medium);
        }
    }
}

TEST(Profile, ScalesWithTheLengths) {
    for (const Subject& subject : subjects()) {
        RandomMedia media(13);
        for (int i = 0; i < std::min(subject.media, 200); ++i) {
            const ChannelMedium medium = media.next();
            const double k = std::pow(10.0, media.between(-3, 3));
            const double thickness = 3 * medium.meanFreePathMm();
            ChannelMedium denser = medium;
            denser.sigmaA *= k;
            denser.sigmaS *= k;
            const auto one = make(subject.name, medium, thickness);
            const auto other = make(subject.name, denser, thickness / k);
            for (const double x : {1e-3, 0.3, 4.0}) {
                const double r = x * one->scaleMm();
                const double expected = k * k * one->reflectance(r);
                ASSERT_NEAR(other->reflectance(r / k), expected, 1e-9 * expected)
                    << subject.name << ": " << describe(medium) << " r " << r;
            }
        }
    }
}

TEST(Profile, ContinuousThroughMatchedIndicesAndVanishingAbsorption) {
    for (const Subject& subject : subjects()) {
        const ChannelMedium matched{0.01, 1, 0.2, 1};
        const ChannelMedium clear{0, 1, 0.2, 1.3};
        for (const double r : {1e-3, 0.5, 5.0, 40.0}) {
            const auto at = [&](ChannelMedium medium) {
                return make(subject.name, medium, 6)->reflectance(r);
            };
            const double one = at(matched);
            for (const double step : {-1e-12, 1e-12}) {
                ChannelMedium near = matched;
                near.eta += step;
                EXPECT_NEAR(at(near), one, 1e-6 * one) << subject.name << " r " << r;
            }
            if (subject.name == "normalized_diffusion_dmfp") continue;
            const double none = at(clear);
            ChannelMedium nearly = clear;
            nearly.sigmaA = 1e-16;
            EXPECT_NEAR(at(nearly), none, 1e-5 * none) << subject.name << " r " << r;
        }
    }
}

TEST(Profile, DerivativeBoundsHoldAndAreNear) {
    for (const Subject& subject : subjects()) {
        for (const ChannelMedium& medium :
             {ChannelMedium{0.0041, 2.62, 0, 1.5}, ChannelMedium{0.97, 0.07, 0, 1.3},
              ChannelMedium{1e-7, 0.4, 0.5, 0.8}}) {
            const auto profile = make(subject.name, medium, 5 * medium.meanFreePathMm());
            const auto f = [&](double r) { return profile->reflectance(r); };
            std::array<double, 3> largest{};  // of the derivatives from here on outwards
            double tightest = 1e300;
            // Closer to the centre the differences would be rounding where the profile is flat.
            const double closest = profile->singularAtZero() ? 1e-3 : 0.1;
            for (double x = 30; x > closest; x *= 0.93) {
                const double r = x * profile->scaleMm(), h = 1e-2 * r;
                if (f(r) < 1e-25 * f(profile->scaleMm())) continue;
                const double first = (f(r + h) - f(r - h)) / (2 * h);
                const double second = (f(r + h) - 2 * f(r) + f(r - h)) / (h * h);
                const double third =
                    (f(r + 2 * h) - 2 * f(r + h) + 2 * f(r - h) - f(r - 2 * h)) / (2 * h * h * h);
                const std::array<double, 3> here{std::abs(first), std::abs(second),
                                                 std::abs(third)};
                for (std::size_t k = 0; k < 3; ++k) {
                    largest[k] = std::max(largest[k], here[k]);
                    const double bound = profile->derivativeBound(static_cast<int>(k) + 1, r);
                    EXPECT_GE(bound, 0.999 * largest[k])
                        << subject.name << " order " << k + 1 << " x " << x;
                    tightest = std::min(tightest, bound / largest[k]);
                }
            }
            EXPECT_LT(tightest, 1.2) << subject.name;
        }
    }
}

TEST(Profile, SinglePrecisionBatchAgrees) {
    for (const Subject& subject : subjects()) {
        RandomMedia media(14);
        for (int i = 0; i < std::min(subject.media, 6); ++i) {
            const ChannelMedium medium = media.next();
            const auto profile =
                make(subject.name, medium, media.between(1.5, 30) * medium.meanFreePathMm());
            const double peak = profile->reflectance(1e-3 * profile->scaleMm());
            std::array<float, 64> r{}, out{};
            for (std::size_t k = 0; k < r.size(); ++k) {
                r[k] = static_cast<float>(profile->scaleMm() *
                                          std::pow(10.0, -3 + 5 * static_cast<double>(k) / 63));
            }
            profile->reflectance(r, out);
            for (std::size_t k = 0; k < r.size(); ++k) {
                const double expected = profile->reflectance(static_cast<double>(r[k]));
                if (expected < 1e-30 * peak || expected < 1e-37) continue;
                EXPECT_NEAR(static_cast<double>(out[k]), expected, 2e-6 * expected)
                    << subject.name << ": " << describe(medium) << " r " << r[k];
            }
        }
    }
}

TEST(Profile, MeanOverItsOwnDisk) {
    const ChannelMedium medium{0.0041, 2.62, 0, 1.5};
    for (const char* name : {"dipole", "normalized_diffusion"}) {
        const auto profile = makeProfile(name, medium);
        for (const double area : {1e-12, 1e-7, 1e-4, 1.0, 1e6}) {
            const double radius = std::sqrt(area / kPi);
            double sum = 0;
            for (int i = 0; i < 200; ++i) {
                sum += gauss16(radius * i / 200, radius * (i + 1) / 200,
                               [&](double r) { return 2 * kPi * r * profile->reflectance(r); });
            }
            EXPECT_NEAR(profile->meanOverDisk(area), sum / area, 1e-6 * sum / area)
                << name << " area " << area;
        }
    }
}

TEST(Profile, UnknownNamesAndMissingOptionsAreExplained) {
    const ChannelMedium medium{0.01, 1, 0, 1.3};
    try {
        makeProfile("beter_dipole", medium);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadInput);
        EXPECT_NE(std::string(error.what()).find("better_dipole"), std::string::npos);
    }
    EXPECT_THROW(makeProfile("multipole", medium), Error);
    EXPECT_THROW(makeProfile("normalized_diffusion_dmfp", {0, 1, 0, 1.3}), Error);
    EXPECT_EQ(energyConvention("jensen"), EnergyConvention::Jensen);
    EXPECT_THROW(energyConvention("jenson"), Error);
}

}  // namespace
