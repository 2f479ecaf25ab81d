// The sum over the octree against the sum over all points.
#include "sss/cloud/diffusion_sum.h"

#include "cloud_tools.h"
#include "sss/base/rng.h"
#include "sss/geom/shapes.h"

#include <gtest/gtest.h>

#include <array>

namespace sss {
namespace {

using testing::Deviations;
using testing::fromOneSide;
using testing::halfPlane;
using testing::LitCloud;
using testing::Optics;
using testing::placesOn;
using testing::sumAt;

// Red light on one half, blue on the other, green on both.
Rgb redAndBlue(const Vec3& p) { return p.x > 0 ? Rgb(1, 0.5f, 0) : Rgb(0, 0.5f, 1); }

// What comes through a slab lit from above, more on one half.
Rgb fromAbove(const Vec3& p) {
    return p.z > 0 ? Rgb(1.0f, 0.9f, 0.7f) * (p.x > 0 ? 1.0f : 0.2f) : Rgb(0.0f);
}
// A warm lamp, a cold one and a little light from everywhere.
Rgb twoLamps(const Vec3& p) {
    const Vec3 n = glm::normalize(p);
    return Rgb(0.02f) + Rgb(1, 0.6f, 0.1f) * std::max(0.0f, n.x) +
           Rgb(0.1f, 0.3f, 1) * std::max(0.0f, n.y - 0.3f);
}

// Hills and hollows: neighbours by air that are not so along the surface, as on a scanned figure.
TriangleMesh makeLumps(double radius) {
    TriangleMesh mesh = makeSphere(radius, radius / 12);
    for (DVec3& p : mesh.positions) {
        const DVec3 n = p / radius;
        p *= 1 + 0.25 * std::sin(5 * n.x + 1) * std::sin(4 * n.y) * std::cos(6 * n.z + n.x);
    }
    mesh.normals.clear();
    return mesh;
}

struct Case {
    const char* name;
    const char* medium;
    TriangleMesh mesh;
    testing::Light light;
    double spacingPerMfp;
    const char* profile = "dipole";
    std::size_t receivers = 1024;
};

std::vector<Case> cases() {
    // The other profiles take turns over the bodies below.
    constexpr std::array kProfiles{"better_dipole",
                                   "normalized_diffusion",
                                   "photon_beam",
                                   "normalized_diffusion_perpendicular",
                                   "multipole",
                                   "normalized_diffusion_dmfp",
                                   "photon_beam_single",
                                   "multipole_transmittance",
                                   "dipole"};
    std::vector<Case> all;
    for (const auto& [medium, perMfp] :
         {std::pair{"marble", 0.75}, {"skimmilk", 0.75}, {"ketchup", 0.45}, {"skin1", 0.6}}) {
        const double l = Optics(medium).smallestMfp();
        all.push_back({"terminator", medium, makeSphere(18 * l), fromOneSide, perMfp});
        all.push_back({"light edge", medium, makeRectangle(50 * l, 25 * l), halfPlane, perMfp});
        all.push_back({"red and blue", medium, makeRectangle(40 * l, 25 * l), redAndBlue, perMfp});
        const auto add = [&](const char* name, TriangleMesh mesh, testing::Light light) {
            const char* profile = kProfiles[all.size() % kProfiles.size()];
            all.push_back({name, medium, std::move(mesh), std::move(light), perMfp, profile, 512});
        };
        add("thin box", makeBox({30 * l, 20 * l, 1.5 * l}), fromAbove);
        add("bar", makeBox({40 * l, 6 * l, 3 * l}), redAndBlue);
        // The lights take turns as well.
        const bool isWarmOnly = all.size() % 2 == 0;
        add("lumps", makeLumps(12 * l), isWarmOnly ? fromOneSide : twoLamps);
    }
    return all;
}

TEST(DiffusionSum, KeepsItsTolerance) {
    for (const Case& c : cases()) {
        const Optics optics(c.medium, c.profile, 6.0);
        const LitCloud cloud(c.mesh, c.spacingPerMfp * optics.smallestMfp(), c.light);
        const KernelTable table = cloud.table(optics, c.mesh.bounds().diagonal());
        const DiffusionSum sum(cloud.view(), cloud.nodes, table);
        const std::vector<Vec3> receivers = placesOn(c.mesh, c.receivers, 4);
        std::vector<DRgb> truth;
        for (const Vec3& p : receivers) truth.push_back(sum.bruteForce(p));
        for (const double tolerance : {0.1, 0.01, 0.001, 0.0001})
            for (const std::size_t group : {1u, 32u}) {
                const std::vector<Rgb> sums = sumAt(sum, receivers, tolerance, group);
                Deviations deviations(tolerance);
                for (std::size_t i = 0; i < sums.size(); ++i) deviations.add(sums[i], truth[i]);
                const auto where = ::testing::Message()
                                   << c.name << ", " << c.medium << ", " << c.profile
                                   << ", tolerance " << tolerance << ", groups of " << group;
                EXPECT_LE(deviations.shareOutside(), 0.001) << where;
                EXPECT_LE(deviations.largest(), 3 * tolerance) << where;
                EXPECT_LE(deviations.bias(), 0.1 * tolerance) << where;
            }
    }
}

// A red lamp on one side, a blue one on the other and a little sky, against the same in white.
TEST(DiffusionSum, ColouredLightCostsLittleMoreThanWhite) {
    const Optics optics("marble");
    const double l = optics.smallestMfp();
    const TriangleMesh mesh = makeSphere(18 * l);
    const std::vector<Vec3> receivers = placesOn(mesh, 512, 4);
    const auto costUnder = [&](const Rgb& left, const Rgb& right) {
        const LitCloud cloud(mesh, 0.75 * l, [&](const Vec3& p) {
            const float x = glm::normalize(p).x;
            return Rgb(0.02f) + left * std::max(0.0f, -x) + right * std::max(0.0f, x);
        });
        const KernelTable table = cloud.table(optics, mesh.bounds().diagonal());
        const DiffusionSum sum(cloud.view(), cloud.nodes, table);
        std::vector<Rgb> out(receivers.size());
        DiffusionSum::Scratch scratch;
        SumCounts counts;
        for (std::size_t i = 0; i < receivers.size(); i += 32)
            sum.evaluate(std::span(receivers).subspan(i, 32), 0.01, std::span(out).subspan(i, 32),
                         scratch, counts);
        return static_cast<double>(counts.interactions());
    };
    const double white = costUnder(Rgb(1.0f), Rgb(1.0f));
    EXPECT_LT(costUnder({1, 0.03f, 0.03f}, {0.03f, 0.03f, 1}), 1.5 * white);
    EXPECT_LT(costUnder({1, 0, 0}, {0, 0, 1}), 2 * white);
}

TEST(DiffusionSum, WithoutToleranceEqualsBruteForce) {
    for (const char* medium : {"marble", "ketchup"}) {
        const Optics optics(medium);
        const double l = optics.smallestMfp();
        const TriangleMesh mesh = makeSphere(8 * l);
        const LitCloud cloud(mesh, 0.6 * l, redAndBlue);
        const KernelTable table = cloud.table(optics, 20 * l);
        const DiffusionSum sum(cloud.view(), cloud.nodes, table);
        const std::vector<Vec3> receivers = placesOn(mesh, 128, 9);
        const std::vector<Rgb> sums = sumAt(sum, receivers, 0, 32);
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            const DRgb truth = sum.bruteForce(receivers[i]);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(static_cast<double>(sums[i][c]), truth[c], 2e-6 * truth[c]);
        }
    }
}

TEST(DiffusionSum, PointsInAnyOrderGiveTheSameAnswer) {
    const Optics optics("marble");
    const TriangleMesh mesh = makeSphere(4);
    const LitCloud cloud(mesh, 0.3, fromOneSide);
    const KernelTable table = cloud.table(optics, 9);
    const std::vector<Vec3> receivers = placesOn(mesh, 96, 2);
    // Shuffled, then put in order again.
    std::vector<std::uint32_t> shuffled(cloud.samples.size());
    for (std::uint32_t i = 0; i < shuffled.size(); ++i) shuffled[i] = i;
    Rng rng(6);
    for (std::size_t i = shuffled.size(); i-- > 1;)
        std::swap(shuffled[i], shuffled[rng.next64() % (i + 1)]);
    std::vector<Vec3> positions;
    for (const std::uint32_t i : shuffled) positions.push_back(cloud.samples.points[i].position);
    std::vector<SurfacePoint> points;
    std::vector<Rgb> irradiance;
    for (const std::uint32_t k : mortonOrder(positions)) {
        points.push_back(cloud.samples.points[shuffled[k]]);
        irradiance.push_back(cloud.irradiance[shuffled[k]]);
    }
    const CloudView again{points, irradiance};
    const auto nodes = buildOctree(again);
    for (const double tolerance : {0.0, 0.01}) {
        const auto a = sumAt({cloud.view(), cloud.nodes, table}, receivers, tolerance, 32);
        const auto b = sumAt({again, nodes, table}, receivers, tolerance, 32);
        EXPECT_EQ(a, b) << tolerance;
    }
}

TEST(DiffusionSum, FewerInteractionsForALargerTolerance) {
    const Optics optics("marble");
    const TriangleMesh mesh = makeSphere(8);
    const LitCloud cloud(mesh, 0.25, fromOneSide);
    const KernelTable table = cloud.table(optics, 17);
    const DiffusionSum sum(cloud.view(), cloud.nodes, table);
    const std::vector<Vec3> receivers = placesOn(mesh, 16384, 2);
    std::vector<Rgb> out(32);
    std::uint64_t previous = 32 * cloud.samples.size() + 1;
    for (const double tolerance : {0.0, 0.0001, 0.001, 0.01, 0.1}) {
        DiffusionSum::Scratch scratch;
        SumCounts counts;
        sum.evaluate(std::span(receivers).first(32), tolerance, out, scratch, counts);
        EXPECT_EQ(counts.receivers, 32u);
        EXPECT_LT(counts.interactions(), previous);
        previous = counts.interactions();
    }
    EXPECT_LT(previous, 32 * 400u);
}

TEST(DiffusionSum, ReceiversOnPointsAndAwayFromTheSurface) {
    const Optics optics("skimmilk");
    const TriangleMesh mesh = makeSphere(6);
    const LitCloud cloud(mesh, 0.4, fromOneSide);
    const KernelTable table = cloud.table(optics, 40);
    const DiffusionSum sum(cloud.view(), cloud.nodes, table);
    std::vector<Vec3> receivers;
    for (std::size_t i = 0; i < cloud.samples.size(); i += 9)
        receivers.push_back(cloud.samples.points[i].position);
    for (int i = 0; i < 64; ++i) receivers.emplace_back(0.2f * static_cast<float>(i), 0.1f, -0.3f);
    const std::vector<Rgb> sums = sumAt(sum, receivers, 0.01, 16);
    Deviations deviations(0.01);
    for (std::size_t i = 0; i < receivers.size(); ++i)
        deviations.add(sums[i], sum.bruteForce(receivers[i]));
    EXPECT_EQ(deviations.shareOutside(), 0);
}

TEST(DiffusionSum, ReceiversFarApartShareAGroup) {
    const Optics optics("marble");
    const TriangleMesh mesh = makeSphere(6);
    const LitCloud cloud(mesh, 0.4, fromOneSide);
    const KernelTable table = cloud.table(optics, 13);
    const DiffusionSum sum(cloud.view(), cloud.nodes, table);
    const std::vector<Vec3> receivers{{6, 0, 0}, {-6, 0, 0}, {0, 6, 0}, {0, 0, -6}};
    const std::vector<Rgb> sums = sumAt(sum, receivers, 0.001, 4);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const DRgb truth = sum.bruteForce(receivers[i]);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(static_cast<double>(sums[i][c]), truth[c], 1e-3 * truth[c]);
    }
}

TEST(DiffusionSum, CoincidentPoints) {
    const Optics optics("marble");
    std::vector<SurfacePoint> points(1000);
    for (SurfacePoint& p : points) {
        p.position = {1, 2, 3};
        p.areaMm2 = 0.01f;
    }
    const std::vector<Rgb> irradiance(1000, Rgb(1, 2, 3));
    const CloudView cloud{points, irradiance};
    const auto nodes = buildOctree(cloud);
    const KernelTable table(optics.pointers(), 50, 0.1);
    const DiffusionSum sum(cloud, nodes, table);
    const std::vector<Vec3> receivers{{1, 2, 3}, {1, 2, 3.5f}, {4, 2, 3}, {-9, 2, 3}};
    for (const double tolerance : {0.0, 0.01}) {
        const auto sums = sumAt(sum, receivers, tolerance, 1);
        for (std::size_t i = 0; i < receivers.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double r = static_cast<double>(glm::length(receivers[i] - receivers[0]));
                const double expected = 10.0 * (c + 1) * optics.profile(c).reflectance(r);
                EXPECT_NEAR(static_cast<double>(sums[i][c]), expected, 2e-5 * expected);
            }
    }
}

TEST(DiffusionSum, NothingComesOfNothing) {
    const Optics optics("marble");
    const KernelTable table(optics.pointers(), 50, 0.1);
    const std::vector<Vec3> receivers{{1, 2, 3}, {0, 0, 0}};
    for (const double tolerance : {0.0, 0.01}) {
        EXPECT_EQ(sumAt({CloudView{}, {}, table}, receivers, tolerance, 2),
                  std::vector<Rgb>(2, Rgb(0.0f)));
        const LitCloud dark(makeSphere(2), 0.3, [](const Vec3&) { return Rgb(0.0f); });
        const DiffusionSum sum(dark.view(), dark.nodes, table);
        EXPECT_EQ(sumAt(sum, receivers, tolerance, 2), std::vector<Rgb>(2, Rgb(0.0f)));
        EXPECT_TRUE(sumAt(sum, {}, tolerance, 2).empty());
    }
}

// What all receivers of a mesh's places cost and get, and how far the sums are from brute force.
struct Cost {
    SumCounts counts;
    double largestMiss = 0;  // relative
};
Cost costOf(const DiffusionSum& sum, std::span<const Vec3> receivers, double tolerance) {
    Cost cost;
    std::vector<Rgb> out(receivers.size());
    DiffusionSum::Scratch scratch;
    sum.evaluate(receivers, tolerance, out, scratch, cost.counts);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const DRgb truth = sum.bruteForce(receivers[i]);
        for (int c = 0; c < 3; ++c)
            cost.largestMiss = std::max(
                cost.largestMiss, std::abs(static_cast<double>(out[i][c]) - truth[c]) / truth[c]);
    }
    return cost;
}

TEST(DiffusionSum, WhatIsDarkCostsNothing) {
    const Optics optics("marble");
    const TriangleMesh mesh = makeSphere(6);
    const LitCloud half(mesh, 0.3, halfPlane);
    const KernelTable table = half.table(optics, 13);
    const std::vector<Vec3> receivers = placesOn(mesh, 32, 2);
    // The same without the points that are dark.
    LitCloud lit = half;
    lit.samples.points.clear();
    lit.irradiance.clear();
    for (std::size_t i = 0; i < half.samples.size(); ++i)
        if (!isZero(half.irradiance[i])) {
            lit.samples.points.push_back(half.samples.points[i]);
            lit.irradiance.push_back(half.irradiance[i]);
        }
    lit.nodes = buildOctree(lit.view());
    const std::size_t litPoints = lit.irradiance.size();
    ASSERT_LT(litPoints, 6 * half.samples.size() / 10);
    for (const double tolerance : {0.0, 0.001}) {
        const Cost all = costOf({lit.view(), lit.nodes, table}, receivers, tolerance);
        const Cost some = costOf({half.view(), half.nodes, table}, receivers, tolerance);
        EXPECT_EQ(all.counts.nodesSkipped + all.counts.pointsSkipped, 0u) << tolerance;
        EXPECT_GT(some.counts.nodesSkipped, 0u) << tolerance;
        // Nodes at the edge of the light are larger with the dark points in them.
        EXPECT_LT(static_cast<double>(some.counts.interactions()),
                  1.05 * static_cast<double>(all.counts.interactions()));
        EXPECT_LT(some.largestMiss, std::max(2e-6, tolerance));
        if (tolerance > 0) continue;
        EXPECT_EQ(some.counts.interactions(), all.counts.interactions());
        // Dark points beside lit ones, and whole dark nodes: no dark point is summed.
        EXPECT_GT(some.counts.pointsSkipped, 0u);
        EXPECT_LE(some.counts.interactions(), 32 * litPoints);
    }
}

TEST(DiffusionSum, WhatLiesBeyondTheProfileCostsNothing) {
    const Optics optics("ketchup");
    const double l = optics.smallestMfp();
    // A strip so long that what leaves its far end is below what single precision holds.
    const TriangleMesh mesh = makeRectangle(1500 * l, 2 * l);
    const LitCloud cloud(mesh, 0.7 * l, [](const Vec3&) { return Rgb(1.0f); });
    const KernelTable table = cloud.table(optics, mesh.bounds().diagonal());
    const std::vector<Vec3> receivers(8, cloud.samples.points.front().position);
    const Cost cost = costOf({cloud.view(), cloud.nodes, table}, receivers, 0);
    EXPECT_GT(cost.counts.nodesSkipped, 0u);
    EXPECT_LT(cost.counts.pointInteractions, 8 * cloud.samples.size() / 2);
    EXPECT_LT(cost.largestMiss, 2e-6);
}

// A channel without light stays without, beside bright ones.
TEST(DiffusionSum, DarkChannelStaysDark) {
    const Optics optics("skin1");
    const TriangleMesh mesh = makeSphere(6);
    const LitCloud cloud(mesh, 0.4, [](const Vec3& p) { return Rgb(p.x > 0 ? 1 : 0, 0, 1); });
    const KernelTable table = cloud.table(optics, 13);
    const DiffusionSum sum(cloud.view(), cloud.nodes, table);
    const std::vector<Vec3> receivers = placesOn(mesh, 256, 2);
    const auto sums = sumAt(sum, receivers, 0.01, 32);
    Deviations deviations(0.01);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        EXPECT_EQ(sums[i].y, 0.0f);
        deviations.add(sums[i], sum.bruteForce(receivers[i]));
    }
    EXPECT_EQ(deviations.shareOutside(), 0);
}

}  // namespace
}  // namespace sss
