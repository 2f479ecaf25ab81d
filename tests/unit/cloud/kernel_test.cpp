// The table of kernels, and its bounds.
#include "cloud_tools.h"
#include "sss/cloud/kernel_table.h"

#include <gtest/gtest.h>

#include <functional>

namespace sss {
namespace {

using testing::Optics;

std::array<const Profile*, 3> threeTimes(const Profile& p) { return {&p, &p, &p}; }

// Relative error of the table where R_d is above 1e-8 of its peak, out to 1000 mean free paths.
double tableError(const Profile& profile, double mfp) {
    const double cell = 0.4 * mfp;
    const KernelTable table(threeTimes(profile), 1000 * mfp, cell);
    const RegularisedProfile regularised(profile, cell);
    const double peak = regularised(0);
    double worst = 0;
    for (int i = 0; i < 600; ++i) {
        const double r = mfp * (i == 0 ? 0.0 : 1e-3 * std::pow(10.0, i * 0.01));
        const auto u = static_cast<float>(r * r);
        const double truth = regularised(std::sqrt(static_cast<double>(u)));
        if (truth < 1e-8 * peak || r > 999 * mfp) continue;
        const Rgb f = table.evaluate(u);
        EXPECT_EQ(f.x, f.y);
        worst = std::max(worst, std::abs(static_cast<double>(f.x) / truth - 1));
    }
    return worst;
}

TEST(KernelTable, EqualsTheProfileOverTwelveDecadesOfScale) {
    for (const double st : {1e-6, 1e-3, 1.0, 1e3, 1e6})
        for (const char* name : {"dipole", "better_dipole"})
            for (const double absorption : {0.0, 1e-3, 0.5, 0.95}) {
                const ChannelMedium m{absorption * st, (1 - absorption) * st, 0, 1.4};
                EXPECT_LT(tableError(*makeProfile(name, m), 1 / st), 1e-4)
                    << name << " " << st << " " << absorption;
            }
}

TEST(KernelTable, EqualsTheProfileAtAnyIndexOfRefraction) {
    for (const double eta : {0.75, 1.0, 1.3, 3.0})
        for (const char* name : {"dipole", "better_dipole"})
            for (const double absorption : {0.0, 0.1}) {
                const ChannelMedium m{2 * absorption, 2 * (1 - absorption), 0, eta};
                EXPECT_LT(tableError(*makeProfile(name, m), 0.5), 1e-4)
                    << name << " " << eta << " " << absorption;
            }
}

TEST(KernelTable, EqualsPhotonBeams) {
    for (const auto& [name, st] : {std::pair{"photon_beam", 1e-6}, {"photon_beam_single", 1e6}}) {
        const ChannelMedium m{0.05 * st, 0.95 * st, 0, 1.3};
        EXPECT_LT(tableError(*makeProfile(name, m), 1 / st), 1e-4) << name;
    }
}

TEST(KernelTable, EqualsNormalizedDiffusionAlsoAtTheRimOfTheCell) {
    for (const double eta : {0.75, 1.0, 3.0}) {
        const ChannelMedium m{0.2, 1.8, 0, eta};
        EXPECT_LT(tableError(*makeProfile("normalized_diffusion", m), 0.5), 1e-4) << eta;
    }
}

TEST(KernelTable, ChannelsStayApart) {
    const Optics optics("skin1");
    const KernelTable table(optics.pointers(), 50, 0.1);
    for (const float r : {0.0f, 0.1f, 0.7f, 3.0f, 12.0f})
        for (int c = 0; c < 3; ++c) {
            const double truth = optics.profile(c).reflectance(static_cast<double>(r));
            EXPECT_NEAR(static_cast<double>(table.evaluate(r * r)[c]), truth, 1e-4 * truth);
        }
}

TEST(KernelTable, IsFiniteAndZeroFarAway) {
    const Optics optics("ketchup");
    const KernelTable table(optics.pointers(), 10, 0.1);
    EXPECT_LT(table.rowCount(), 400u);
    for (const float u : {1e3f, 1e10f, 1e30f, 3e38f}) {
        EXPECT_TRUE(isFinite(table.evaluate(u))) << u;
        EXPECT_TRUE(isZero(table.evaluate(u * 10))) << u;
    }
}

TEST(KernelTable, SingularProfileKeepsItsTotal) {
    const Optics optics("marble", "normalized_diffusion");
    const Profile& p = optics.profile(1);
    for (const double cell : {0.02, 0.1, 0.4}) {
        // Integral of 2 pi r R dr = of pi R du, by steps even in log u.
        const RegularisedProfile regularised(p, cell);
        double sum = 0;
        const double du = 0.01;
        for (double logU = std::log(1e-10); logU < std::log(1e4); logU += du)
            sum += kPi * std::exp(logU) * du * regularised(std::sqrt(std::exp(logU)));
        EXPECT_NEAR(sum / p.total(), 1.0, 2e-4) << cell;
        EXPECT_TRUE(std::isfinite(regularised(0)));
        EXPECT_EQ(regularised(5.1 * cell), p.reflectance(5.1 * cell));
    }
}

// Largest |d^k/dt^k f(|x + t e|)| over directions e at distance r: the norm of the symmetric
// derivative tensor, by finite differences.
double tensorNorm(const std::function<double(double)>& f, int order, double r, double h) {
    double worst = 0;
    for (int i = 0; i <= 24; ++i) {
        const double phi = i / 24.0 * kPi / 2, c = std::cos(phi), s = std::sin(phi);
        const auto at = [&](double t) { return f(std::hypot(r + t * c, t * s)); };
        double d = 0;
        if (order == 0) d = f(r);
        if (order == 1) d = (at(h) - at(-h)) / (2 * h);
        if (order == 2) d = (at(h) - 2 * at(0) + at(-h)) / (h * h);
        if (order == 3) d = (at(2 * h) - 2 * at(h) + 2 * at(-h) - at(-2 * h)) / (2 * h * h * h);
        worst = std::max(worst, std::abs(d));
    }
    return worst;
}

TEST(KernelTable, BoundsHoldAndDecrease) {
    for (const auto& [name, model] : {std::pair{"marble", "dipole"},
                                      {"ketchup", "dipole"},
                                      {"skimmilk", "better_dipole"},
                                      {"skin1", "normalized_diffusion"}}) {
        const Optics optics(name, model);
        const double l = optics.smallestMfp(), cell = 0.4 * l;
        const KernelTable table(optics.pointers(), 100 * l, cell);
        const std::array<RegularisedProfile, 3> regularised{
            RegularisedProfile(optics.profile(0), cell),
            RegularisedProfile(optics.profile(1), cell),
            RegularisedProfile(optics.profile(2), cell)};
        Rgb previous[4], largest[4];
        std::fill(std::begin(previous), std::end(previous), Rgb(1e30f));
        std::fill(std::begin(largest), std::end(largest), Rgb(0.0f));
        for (int i = 0; i < 150; ++i) {
            const double r = 0.01 * l * std::pow(1.055, i);
            const KernelTable::BoundsRow& bounds = table.boundsAt(static_cast<float>(r * r));
            for (int k = 0; k < 4; ++k)
                for (int c = 0; c < 3; ++c) {
                    const float bound = bounds.derivative[k][c];
                    EXPECT_LE(bound, previous[k][c]);
                    previous[k][c] = bound;
                    const auto f = [&](double x) {
                        return regularised[static_cast<std::size_t>(c)](x);
                    };
                    if (f(r) < 1e-12 * f(0)) continue;
                    // Steps in which single precision does not show.
                    const double norm = tensorNorm(f, k, r, 6e-3 * std::hypot(r, 0.3 * l));
                    EXPECT_GE(static_cast<double>(bound), 0.999 * norm)
                        << name << " " << model << " order " << k << " r/l " << r / l;
                    largest[k][c] = std::max(largest[k][c], static_cast<float>(norm));
                }
        }
        // Nor are they larger than need be where they say most, at the receiver itself.
        for (int k = 0; k < 4; ++k)
            for (int c = 0; c < 3; ++c)
                EXPECT_LE(table.boundsAt(0).derivative[k][c], 3 * largest[k][c])
                    << name << " " << model << " order " << k;
    }
}

}  // namespace
}  // namespace sss
