// The table of kernels, its bounds, and the loops that sum with it.
#include "cloud_tools.h"
#include "sss/base/rng.h"
#include "sss/cloud/interactions.h"
#include "sss/cloud/kernel_table.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

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

TEST(KernelTable, EqualsPhotonBeamDiffusion) {
    for (const double st : {1e-6, 1e6}) {
        const ChannelMedium m{0.05 * st, 0.95 * st, 0, 1.3};
        EXPECT_LT(tableError(*makeProfile("photon_beam", m), 1 / st), 1e-4) << st;
    }
}

// The mean of 1 / r over a disk has a kink at the disk's rim, which a cubic cuts short.
TEST(KernelTable, EqualsNormalizedDiffusionButForTheRimOfTheCell) {
    for (const double eta : {0.75, 1.0, 3.0}) {
        const ChannelMedium m{0.2, 1.8, 0, eta};
        EXPECT_LT(tableError(*makeProfile("normalized_diffusion", m), 0.5), 2e-3) << eta;
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
        Rgb previous[4];
        std::fill(std::begin(previous), std::end(previous), Rgb(1e30f));
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
                    EXPECT_GE(static_cast<double>(bound),
                              0.999 * tensorNorm(f, k, r, 2e-3 * std::hypot(r, 0.3 * l)))
                        << name << " " << model << " order " << k << " r/l " << r / l;
                }
        }
    }
}

InteractionList randomList(std::size_t count, std::uint64_t seed, bool withMoments) {
    Rng rng(seed);
    InteractionList list;
    for (std::size_t i = 0; i < count; ++i) {
        OctreeNode node;
        node.centroid = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 12.0f;
        node.flux = {rng.uniform(), 3 * rng.uniform(), i % 5 == 0 ? 0.0f : rng.uniform()};
        const Vec3 a{rng.uniform(), rng.uniform(), rng.uniform()};
        for (int k = 0; k < 3; ++k) node.moments[k] = 0.05f * a[k] * a[k];
        node.moments[3] = 0.05f * a.x * a.y;
        node.moments[4] = 0.05f * a.x * a.z;
        node.moments[5] = 0.05f * a.y * a.z;
        if (withMoments)
            list.addNode(node);
        else
            list.addPoint(node.centroid, node.flux);
    }
    list.pad();
    return list;
}

void compareWithScalar(const char* target) {
    const Optics optics("skin1");
    const KernelTable table(optics.pointers(), 8, 0.1);  // sources beyond the reach, too
    Rng rng(3);
    std::vector<Vec3> receivers;
    for (int i = 0; i < 17; ++i)
        receivers.push_back(Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 12.0f);
    for (const bool withMoments : {false, true})
        for (const std::size_t count : {0u, 1u, 2u, 63u, 64u, 65u, 200u, 1000u}) {
            const InteractionList list = randomList(count, count + 1, withMoments);
            EXPECT_EQ(list.size(), count);
            std::vector<DRgb> sums(receivers.size(), DRgb(0.25)), expected = sums;
            accumulate(table, list, withMoments, receivers, sums);
            accumulateScalar(table, list, withMoments, receivers, expected);
            for (std::size_t r = 0; r < receivers.size(); ++r)
                for (int c = 0; c < 3; ++c) {
                    EXPECT_TRUE(count == 0 || expected[r][c] > 0.25 || count < 64);
                    EXPECT_NEAR(sums[r][c], expected[r][c], 1e-5 * (expected[r][c] - 0.25) + 1e-12)
                        << target << " " << count << " " << withMoments;
                }
        }
}

TEST(Accumulate, EveryInstructionSetAgreesWithTheReference) {
    const std::int64_t available = hwy::SupportedTargets();
    int tested = 0;
    for (std::int64_t bit = 1; bit > 0 && bit <= available; bit <<= 1) {
        if ((available & bit) == 0) continue;
        hwy::SetSupportedTargetsForTest(bit);
        hwy::GetChosenTarget().Update(bit);
        compareWithScalar(hwy::TargetName(bit));
        ++tested;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
    EXPECT_GT(tested, 0);
    compareWithScalar(accumulateTarget());
}

TEST(Accumulate, ListsCanBeUsedAgain) {
    InteractionList list = randomList(300, 1, true);
    list.clear();
    EXPECT_EQ(list.size(), 0u);
    EXPECT_TRUE(list.blocks().empty());
    list.addPoint({1, 2, 3}, Rgb(1.0f));
    list.pad();
    EXPECT_EQ(list.size(), 1u);
    const Optics optics("marble");
    const KernelTable table(optics.pointers(), 20, 0.1);
    std::vector<DRgb> sums(1, DRgb(0));
    accumulate(table, list, false, std::vector<Vec3>{{1, 2, 4}}, sums);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sums[0][c], optics.profile(c).reflectance(1), 1e-5 * sums[0][c]);
}

// One node of 100 points seen from farther and farther away: what the second moments leave out
// falls with the third power of size / distance, what the centroid alone leaves out with the
// second.
TEST(Accumulate, SecondMomentsLeaveOutTheThirdOrder) {
    const ChannelMedium medium{0, 1, 0, 1.3};  // no absorption: power laws
    const auto profile = makeProfile("dipole", medium);
    const KernelTable table(threeTimes(*profile), 1e4, 0.1);
    Rng rng(21);
    std::vector<SurfacePoint> points;
    std::vector<Rgb> irradiance;
    for (int i = 0; i < 100; ++i) {
        SurfacePoint p;
        p.position =
            Vec3(rng.uniform() * rng.uniform(), rng.uniform(), 0.5f * rng.uniform()) * 20.0f;
        p.areaMm2 = 0.5f + rng.uniform();
        points.push_back(p);
        irradiance.emplace_back(rng.uniform());
    }
    // As one node: the root, whatever is below it.
    std::vector<Vec3> positions;
    for (const SurfacePoint& p : points) positions.push_back(p.position);
    std::vector<SurfacePoint> sorted;
    std::vector<Rgb> sortedIrradiance;
    for (const std::uint32_t i : mortonOrder(positions)) {
        sorted.push_back(points[i]);
        sortedIrradiance.push_back(irradiance[i]);
    }
    const CloudView cloud{sorted, sortedIrradiance};
    const auto nodes = buildOctree(cloud);
    const DiffusionSum sum(cloud, nodes, table);
    const auto errorAt = [&](float distance, bool withMoments) {
        double worst = 0;
        for (int k = 0; k < 40; ++k) {
            const float phi = 0.157f * static_cast<float>(k),
                        z = 0.04f * static_cast<float>(k) - 0.8f;
            const float s = std::sqrt(1 - z * z);
            const std::vector<Vec3> at{nodes[0].centroid +
                                       distance * Vec3(s * std::cos(phi), s * std::sin(phi), z)};
            InteractionList list;
            list.addNode(nodes[0]);
            list.pad();
            std::vector<DRgb> result(1, DRgb(0));
            accumulateScalar(table, list, withMoments, at, result);
            worst = std::max(worst, std::abs(result[0].x / sum.bruteForce(at[0]).x - 1));
        }
        return worst;
    };
    for (const float distance : {50.0f, 100.0f, 200.0f}) {
        EXPECT_NEAR(errorAt(distance, true) / errorAt(2 * distance, true), 8, 2.5) << distance;
        EXPECT_NEAR(errorAt(distance, false) / errorAt(2 * distance, false), 4, 1) << distance;
    }
    EXPECT_LT(errorAt(100, true), 0.2 * errorAt(100, false));
}

}  // namespace
}  // namespace sss
