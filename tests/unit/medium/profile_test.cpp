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
    int media;          ///< random media per property
    double quadrature;  ///< tolerance of total against the integral of the profile
    int batches;        ///< media whose batch path is tried: each builds a table where it is slow
};

/// All but the simulated one, which has its own test.
const std::vector<Subject>& subjects() {
    static const std::vector<Subject> all{
        {"dipole", 4000, 1e-9, 2000},
        {"better_dipole", 4000, 1e-9, 2000},
        {"normalized_diffusion", 2000, 1e-9, 1000},
        {"normalized_diffusion_perpendicular", 2000, 1e-9, 1000},
        {"normalized_diffusion_dmfp", 2000, 1e-9, 1000},
        {"multipole", 1000, 1e-8, 12},
        {"multipole_transmittance", 1000, 1e-8, 12},
        {"photon_beam", 1000, 1e-8, 12},
        {"photon_beam_single", 1000, 1e-8, 12},
    };
    return all;
}

std::unique_ptr<Profile> profileOf(const std::string& name, ChannelMedium medium,
                                   double thickness) {
    ProfileOptions options;
    options.slabThicknessMm = thickness;
    if (name == "normalized_diffusion_dmfp" && medium.sigmaA == 0) {
        medium.sigmaA = 1e-9 * medium.sigmaTPrime();
    }
    return makeProfile(name, medium, options);
}

/// The integral of 2 pi r R_d by the trapezoidal rule in log r, every value of which is checked to
/// be finite, not negative and not above the one before. The rule converges exponentially, because
/// every profile is analytic but for sources on the imaginary axis of r, a quarter turn away: its
/// error is e^{-pi^2/h}. At the ends 1e-10 of the total at most is left out.
double checkedIntegral(const Profile& profile, const std::string& where) {
    constexpr double kStep = 0.28;
    double sum = 0;
    double last = profile.reflectance(0.0);
    EXPECT_EQ(std::isinf(last), profile.singularAtZero()) << where;
    for (double x = 1e-12; x < 1e14; x *= std::exp(kStep)) {
        const double r = x * profile.scaleMm();
        const double value = profile.reflectance(r);
        // An ulp or more of slack: far below the mean free path the profile is flat.
        if (!(std::isfinite(value) && value >= 0 && value <= last * (1 + 1e-13))) {
            ADD_FAILURE() << where << ": " << value << " after " << last << " at r = " << r;
            break;
        }
        last = value;
        sum += r * r * value;
        if (x > 1 && r * r * value < 1e-17 * sum) break;
    }
    return 2 * kPi * sum * kStep;
}

TEST(Profile, FiniteNonNegativeDecreasingAndItsIntegralIsTheTotal) {
    for (const Subject& subject : subjects()) {
        RandomMedia media(11);
        for (int i = 0; i < subject.media && !HasFailure(); ++i) {
            const ChannelMedium medium = media.next();
            // From a thousandth of a mean free path.
            const double thickness = std::pow(10.0, media.between(-3, 1)) * medium.meanFreePathMm();
            const auto profile = profileOf(subject.name, medium, thickness);
            const std::string where = subject.name + ": " + describe(medium);
            const double total = profile->total();
            EXPECT_TRUE(total >= 0 && total <= 1) << where << ": " << total;
            EXPECT_NEAR(checkedIntegral(*profile, where), total, subject.quadrature * total + 1e-15)
                << where << " thickness " << thickness;
            double lastTail = profile->tail(0.0);
            EXPECT_NEAR(lastTail, total, 1e-12) << where;
            for (const double x : {1e-4, 0.2, 3.0, 1e3}) {
                const double tail = profile->tail(x * profile->scaleMm());
                EXPECT_TRUE(tail >= 0 && tail <= lastTail * (1 + 1e-11) + 1e-15)
                    << where << ": tail " << tail << " after " << lastTail << " at x = " << x;
                lastTail = tail;
            }
        }
    }
}

TEST(Profile, TailIsTheQuadratureOfTheProfile) {
    for (const Subject& subject : subjects()) {
        RandomMedia media(17);
        for (int i = 0; i < 40; ++i) {
            const ChannelMedium medium = media.next();
            const auto profile =
                profileOf(subject.name, medium, media.between(1.5, 30) * medium.meanFreePathMm());
            const double a = profile->scaleMm() * std::pow(10.0, media.between(-3, 1));
            double sum = 0, lo = 0;
            for (double hi = 1e-6 * a; lo < a; hi = std::min(3 * hi, a)) {
                sum += gauss16(lo, hi,
                               [&](double r) { return 2 * kPi * r * profile->reflectance(r); });
                lo = hi;
            }
            EXPECT_NEAR(sum + profile->tail(a), profile->total(),
                        subject.quadrature * profile->total() + 1e-15)
                << subject.name << ": " << describe(medium) << " a " << a;
        }
    }
}

TEST(Profile, ScalesWithTheLengths) {
    for (const Subject& subject : subjects()) {
        RandomMedia media(13);
        for (int i = 0; i < subject.media; ++i) {
            const ChannelMedium medium = media.next();
            const double k = std::pow(10.0, media.between(-3, 3));
            const double thickness = 3 * medium.meanFreePathMm();
            ChannelMedium denser = medium;
            denser.sigmaA *= k;
            denser.sigmaS *= k;
            const auto one = profileOf(subject.name, medium, thickness);
            const auto other = profileOf(subject.name, denser, thickness / k);
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
                return profileOf(subject.name, medium, 6)->reflectance(r);
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

// The same for random media, at the radii where they vary.
TEST(Profile, ContinuousForRandomMedia) {
    for (const Subject& subject : subjects()) {
        RandomMedia media(19);
        for (int i = 0; i < 100; ++i) {
            ChannelMedium medium = media.next();
            const double r = std::pow(10.0, media.between(-3, 1)) * medium.meanFreePathMm();
            const auto at = [&](const ChannelMedium& m) {
                return profileOf(subject.name, m, 3 * medium.meanFreePathMm())->reflectance(r);
            };
            medium.eta = 1;
            ChannelMedium near = medium;
            near.eta = 1 + 1e-12;
            const double matched = at(medium);
            EXPECT_NEAR(at(near), matched, 1e-6 * matched + 1e-290)
                << subject.name << ": " << describe(medium) << " r " << r;
            if (subject.name == "normalized_diffusion_dmfp" || medium.sigmaS == 0) continue;
            medium.sigmaA = 0;
            near = medium;
            near.sigmaA = 1e-16 * medium.sigmaTPrime();
            const double clear = at(medium);
            EXPECT_NEAR(at(near), clear, 1e-6 * clear)
                << subject.name << ": " << describe(medium) << " r " << r;
        }
    }
}

TEST(Profile, DerivativeBoundsHoldAndAreNear) {
    for (const Subject& subject : subjects()) {
        for (const ChannelMedium& medium :
             {ChannelMedium{0.0041, 2.62, 0, 1.5}, ChannelMedium{0.97, 0.07, 0, 1.3},
              ChannelMedium{1e-7, 0.4, 0.5, 0.8}}) {
            const auto profile = profileOf(subject.name, medium, 5 * medium.meanFreePathMm());
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

/// Wherever R_d is above 1e-30 of its peak (of its value at a thousandth of a mean free path, where
/// the peak is infinite) and is a number of normal single precision.
TEST(Profile, SinglePrecisionBatchAgrees) {
    for (const Subject& subject : subjects()) {
        RandomMedia media(14);
        for (int i = 0; i < subject.batches; ++i) {
            const ChannelMedium medium = media.next();
            const auto profile =
                profileOf(subject.name, medium, media.between(1.5, 30) * medium.meanFreePathMm());
            const double peak = profile->reflectance(1e-3 * profile->scaleMm());
            std::array<float, 64> r{}, out{};
            for (std::size_t k = 0; k < r.size(); ++k) {
                const double decades = -8 + 19 * static_cast<double>(k) / 63;
                r[k] = static_cast<float>(profile->scaleMm() * std::pow(10.0, decades));
            }
            profile->reflectance(r, out);
            for (std::size_t k = 0; k < r.size(); ++k) {
                const double expected = profile->reflectance(static_cast<double>(r[k]));
                if (expected < 1e-30 * peak || expected < 1.2e-38) continue;
                ASSERT_NEAR(static_cast<double>(out[k]), expected, 2e-6 * expected)
                    << subject.name << ": " << describe(medium) << " r " << r[k];
            }
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
