#include "sss/integrate/probe_radius.h"

#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

#include <memory>

namespace sss {
namespace {

constexpr double kReach = 80;  // mm

struct Profiles {
    std::array<std::unique_ptr<Profile>, 3> owned;

    Profiles(const char* name, const Medium& medium) {
        for (int c = 0; c < 3; ++c)
            owned[static_cast<std::size_t>(c)] = makeProfile(name, medium.channel(c));
    }
    std::array<const Profile*, 3> pointers() const {
        return {owned[0].get(), owned[1].get(), owned[2].get()};
    }
};

Medium coloured(double sigmaA) {
    Medium medium;
    medium.sigmaA = DRgb(sigmaA, 3 * sigmaA, 10 * sigmaA);
    medium.sigmaS = {0.5, 2, 8};
    medium.eta = 1.3;
    return medium;
}

TEST(ProbeRadius, IntegratesToOneOverItsDisk) {
    for (const char* name : {"dipole", "better_dipole", "normalized_diffusion"})
        for (const double sigmaA : {0.0, 0.1}) {
            SCOPED_TRACE(::testing::Message() << name << ' ' << sigmaA);
            const Profiles profiles(name, coloured(sigmaA));
            const ProbeRadius radius(profiles.pointers(), kReach);
            // Over ln r, from far below any feature on.
            const double first = std::log(1e-8), last = std::log(kReach);
            const double sum = testing::integrate01(20000, [&](double x) {
                const double r = std::exp(first + (last - first) * x);
                return 2 * kPi * r * r * (last - first) *
                       static_cast<double>(radius.density(static_cast<float>(r)));
            });
            EXPECT_NEAR(sum, 1, 1e-3);
            EXPECT_EQ(radius.density(static_cast<float>(kReach) * 1.001f), 0.0f);
        }
}

// As many samples within a radius as the channels' profiles put there, in the mean.
TEST(ProbeRadius, FollowsTheProfiles) {
    const Profiles profiles("normalized_diffusion", coloured(0.05));
    const ProbeRadius radius(profiles.pointers(), kReach);
    float before = 0;
    for (int i = 0; i < 200; ++i) {
        const double u = (i + 0.5) / 200;
        const float r = radius.sample(static_cast<float>(u));
        EXPECT_GE(r, before);
        before = r;
        double within = 0;
        for (const auto& profile : profiles.owned) {
            const double all = profile->total() - profile->tail(kReach);
            within += (profile->total() - profile->tail(static_cast<double>(r))) / all / 3;
        }
        EXPECT_NEAR(within, u, 1e-3);
    }
}

// A channel in which nothing is scattered takes no part.
TEST(ProbeRadius, LeavesOutWhatScattersNothing) {
    Medium medium = coloured(0.1);
    medium.sigmaS = {0, 2, 0};
    const Profiles one("dipole", medium);
    medium.sigmaS = DRgb(2);
    medium.sigmaA = DRgb(medium.sigmaA.y);
    const Profiles grey("dipole", medium);
    const ProbeRadius a(one.pointers(), kReach), b(grey.pointers(), kReach);
    EXPECT_FALSE(a.isEmpty());
    for (const float u : {0.1f, 0.5f, 0.9f}) EXPECT_NEAR(a.sample(u), b.sample(u), 2e-3f);
    medium.sigmaS = DRgb(0);
    EXPECT_TRUE(ProbeRadius(Profiles("dipole", medium).pointers(), kReach).isEmpty());
}

}  // namespace
}  // namespace sss
