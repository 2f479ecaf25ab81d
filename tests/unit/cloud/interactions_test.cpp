// The vector loops of the diffusion sum: interactions, expansions, verdicts.
#include "sss/cloud/interactions.h"

#include "cloud_tools.h"
#include "sss/base/rng.h"
#include "sss/cloud/candidates.h"
#include "sss/cloud/kernel_table.h"
#include "sss/cloud/local_expansion.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <bit>
#include <string>

namespace sss {
namespace {

using testing::Optics;

// All indices of so many nodes, last to first: the order of a list is not that of the nodes.
std::vector<std::uint32_t> backwards(std::size_t count) {
    std::vector<std::uint32_t> indices;
    for (std::size_t i = count; i-- > 0;) indices.push_back(static_cast<std::uint32_t>(i));
    return indices;
}

std::vector<OctreeNode> randomSources(std::size_t count, std::uint64_t seed, bool isColoured) {
    Rng rng(seed);
    std::vector<OctreeNode> nodes(count);
    for (std::size_t i = 0; i < count; ++i) {
        OctreeNode& node = nodes[i];
        node.centroid = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 12.0f;
        node.flux = {rng.uniform(), 3 * rng.uniform(),
                     i % 5 == 0 && !isColoured ? 0.0f : rng.uniform()};
        node.areaMm2 = 1 + rng.uniform();
        const Vec3 a{rng.uniform(), rng.uniform(), rng.uniform()};
        for (int k = 0; k < 3; ++k) node.moments[k] = 0.05f * a[k] * a[k];
        node.moments[3] = 0.05f * a.x * a.y;
        node.moments[4] = 0.05f * a.x * a.z;
        node.moments[5] = 0.05f * a.y * a.z;
        if (!isColoured) continue;
        for (Vec3& lean : node.lean)
            lean = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 0.04f - 0.02f;
    }
    return nodes;
}

// A point of area 1.
void addPoint(InteractionList& list, const Vec3& position, const Rgb& flux) {
    SurfacePoint point;
    point.position = position;
    point.areaMm2 = 1;
    list.addPoints({&point, 1}, {&flux, 1});
}

InteractionList randomList(std::size_t count, std::uint64_t seed, bool withMoments,
                           bool isColoured = false) {
    const std::vector<OctreeNode> nodes = randomSources(count, seed, isColoured);
    InteractionList list;
    if (withMoments)
        list.setNodes(nodes, backwards(count));
    else
        for (const OctreeNode& node : nodes) addPoint(list, node.centroid, node.flux);
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
    for (const auto& [withMoments, isColoured] :
         {std::pair(false, false), std::pair(true, false), std::pair(true, true)})
        for (const std::size_t count : {0u, 1u, 2u, 63u, 64u, 65u, 200u, 1000u}) {
            const InteractionList list = randomList(count, count + 1, withMoments, isColoured);
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

void compareExpansionsWithScalar(const char* target) {
    const Optics optics("skin1");
    const KernelTable table(optics.pointers(), 8, 0.1);
    for (const std::size_t count : {0u, 1u, 63u, 65u, 200u, 264u}) {
        const InteractionList list = randomList(count, count + 1, true, count % 4 == 0);
        LocalExpansion fast, reference;
        fast.centre = reference.centre = {3, 20, 5};
        fast.value = reference.value = DRgb(1e-9);
        accumulate(table, list, fast);
        accumulateScalar(table, list, reference);
        EXPECT_LT(glm::length(fast.value - reference.value), 1e-5 * glm::length(reference.value));
        const auto close = [&](const auto& a, const auto& b) {
            double worst = 0, largest = 0;
            for (std::size_t k = 0; k < a.size(); ++k) {
                worst = std::max(worst, glm::length(a[k] - b[k]));
                largest = std::max(largest, glm::length(b[k]));
            }
            return worst <= 1e-5 * largest;
        };
        EXPECT_TRUE(close(fast.gradient, reference.gradient)) << target << " " << count;
        EXPECT_TRUE(close(fast.hessian, reference.hessian)) << target << " " << count;
    }
}

std::vector<OctreeNode> randomCandidates(std::size_t count, bool coloured) {
    Rng rng(count + 7);
    std::vector<OctreeNode> nodes(count);
    for (std::size_t i = 0; i < count; ++i) {
        OctreeNode& node = nodes[i];
        node.centroid = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 12.0f;
        node.flux = Rgb(rng.uniform(), i % 5 == 0 ? 0.0f : rng.uniform(), 3 * rng.uniform());
        if (i % 7 == 0) node.flux = Rgb(0.0f);
        node.cubicMean = 0.4f * rng.uniform();
        node.radius = 0.3f + rng.uniform();
        node.count = i % 3 == 0 ? OctreeNode::kLeaf | 5 : 5;
        if (coloured) node.chromaticMoment = 0.02f * rng.uniform();
    }
    return nodes;
}

void compareVerdictsWithScalar(const char* target) {
    const Optics optics("skin1");
    const KernelTable table(optics.pointers(), 8, 0.1);
    std::size_t taken = 0, dark = 0, fine = 0, total = 0;
    for (const bool coloured : {false, true})
        for (const float share : {0.0f, 1e-6f, 1e-4f})
            for (const std::size_t count : {1u, 5u, 64u, 300u}) {
                const std::vector<OctreeNode> nodes = randomCandidates(count, coloured);
                const std::vector<std::uint32_t> indices = backwards(count);
                const CellTest cell{{6, 6, 6}, 0.7f, 0.4f, {share, 2 * share, share}};
                ErrorBound fast, reference;
                bool anyTaken = false;
                for (std::size_t i = 0; i < count; i += kMostJudged) {
                    const auto some =
                        std::span(indices).subspan(i, std::min(kMostJudged, count - i));
                    const Verdict a = judge(table, nodes, some, cell, fast);
                    const Verdict b = judgeScalar(table, nodes, some, cell, reference);
                    // Fused steps round otherwise: a node may be just on the other side of a limit.
                    EXPECT_LE(std::popcount(a.taken ^ b.taken), 1) << target << " " << share;
                    EXPECT_LE(std::popcount(a.dark ^ b.dark), 1) << target << " " << share;
                    EXPECT_LE(std::popcount(a.fine ^ b.fine), 1) << target << " " << share;
                    taken += static_cast<std::size_t>(std::popcount(a.taken));
                    dark += static_cast<std::size_t>(std::popcount(a.dark));
                    fine += static_cast<std::size_t>(std::popcount(a.fine));
                    total += some.size();
                    anyTaken |= b.taken != 0;
                }
                for (int c = 0; c < 3; ++c) {
                    EXPECT_NEAR(fast.changing[c], reference.changing[c],
                                0.02 * reference.changing[c]);
                    EXPECT_NEAR(fast.steady[c], reference.steady[c], 0.02 * reference.steady[c]);
                    EXPECT_EQ(reference.steady.x > 0, coloured && share > 0 && anyTaken);
                }
            }
    EXPECT_GT(taken, total / 10) << target;
    EXPECT_GT(dark, total / 20) << target;
    EXPECT_GT(fine, total / 3) << target;
    EXPECT_LT(fine, total) << target;
    EXPECT_LT(taken + dark, total) << target;
}

void comparePackingWithScalar(const char* target) {
    for (const std::size_t count : {1u, 2u, 3u, 4u, 61u, 64u}) {
        const std::vector<OctreeNode> nodes = randomSources(count, count, count % 2 == 0);
        const std::vector<std::uint32_t> indices = backwards(count);
        InteractionList::Block fast, reference;
        pack(nodes, indices, fast);
        packScalar(nodes, indices, reference);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_EQ(Vec3(fast.x[i], fast.y[i], fast.z[i]),
                      Vec3(reference.x[i], reference.y[i], reference.z[i]))
                << target << " " << i << " of " << count;
            for (std::size_t k = 0; k < 6; ++k)
                EXPECT_EQ(fast.moments[k][i], reference.moments[k][i]) << target << " " << i;
            for (std::size_t c = 0; c < 4; ++c)
                EXPECT_EQ(fast.flux[i][c], reference.flux[i][c]) << target << " " << i;
            EXPECT_EQ(fast.isColoured, count % 2 == 0);
            if (!fast.isColoured) continue;
            Vec3 sum(0);
            for (int c = 0; c < 3; ++c) {
                EXPECT_EQ(leanOf(fast, i, c), leanOf(reference, i, c)) << target << " " << i;
                sum += leanOf(fast, i, c);
            }
            EXPECT_LT(glm::length(sum), 1e-6f);
            EXPECT_EQ(fast.meanFlux[i], reference.meanFlux[i]);
        }
    }
}

// What this machine can run and must have been compiled: the fallback that every machine runs (as
// one of its two names), and the steps up from it.
std::vector<std::string> requiredTargets(bool isEmulated) {
    std::vector<std::string> required{isEmulated ? "EMU128" : "SCALAR"};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("ssse3")) required.emplace_back("SSSE3");
    if (__builtin_cpu_supports("sse4.2")) required.emplace_back("SSE4");
    if (__builtin_cpu_supports("avx2")) required.emplace_back("AVX2");
    if (__builtin_cpu_supports("avx512bw")) required.emplace_back("AVX3");
#endif
    return required;
}

TEST(Accumulate, EveryInstructionSetAgreesWithTheReference) {
    const std::int64_t available = hwy::SupportedTargets();
    std::vector<std::string> tested;
    for (std::int64_t bit = 1; bit > 0 && bit <= available; bit <<= 1) {
        if ((available & bit) == 0) continue;
        hwy::SetSupportedTargetsForTest(bit);
        hwy::GetChosenTarget().Update(bit);
        compareWithScalar(hwy::TargetName(bit));
        compareExpansionsWithScalar(hwy::TargetName(bit));
        compareVerdictsWithScalar(hwy::TargetName(bit));
        comparePackingWithScalar(hwy::TargetName(bit));
        tested.emplace_back(accumulateTarget());  // what ran in fact
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
    const auto wasTested = [&](const std::string& target) {
        return std::find(tested.begin(), tested.end(), target) != tested.end();
    };
    for (const std::string& target : requiredTargets(wasTested("EMU128")))
        EXPECT_TRUE(wasTested(target)) << target;
    compareWithScalar(accumulateTarget());
}

// The polynomial has the sum's own value, slope and curvature: it misses by third order only.
void expectSecondOrder(const InteractionList& list) {
    const Optics optics("marble");
    const KernelTable table(optics.pointers(), 40, 0.1);
    LocalExpansion expansion;
    expansion.centre = {6, 6, 17};  // 5 mm above sources that extend over 0.2 mm
    accumulateScalar(table, list, expansion);
    const Vec3 direction = glm::normalize(Vec3(1, 2, -0.5f));
    double previous = 0;
    for (const float step : {0.5f, 1.0f, 2.0f}) {
        const Vec3 place = expansion.centre + direction * step;
        std::vector<DRgb> sum(1, DRgb(0));
        accumulateScalar(table, list, true, std::vector<Vec3>{place}, sum);
        const double miss = glm::length(expansion.at(place) - sum[0]) / glm::length(sum[0]);
        EXPECT_LT(miss, 0.01 * std::pow(step, 3)) << step;
        if (previous > 1e-4) {
            EXPECT_GT(miss / previous, 4);
        }
        previous = miss;
        EXPECT_LT(
            glm::length(expansion.movedTo({6.5f, 5.6f, 17.3f}).at(place) - expansion.at(place)),
            1e-6 * glm::length(sum[0]));
    }
}

TEST(LocalExpansion, FollowsTheSumToSecondOrder) {
    for (const bool isColoured : {false, true})
        expectSecondOrder(randomList(100, 3, true, isColoured));
}

TEST(Accumulate, DarkPointsAreLeftOut) {
    // More than a block, of which every third is dark: the others stand in their order.
    std::vector<SurfacePoint> points(200);
    std::vector<Rgb> irradiance(200);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].position = Vec3(static_cast<float>(i), 2, 3);
        points[i].areaMm2 = 2;
        irradiance[i] = i % 3 == 0 ? Rgb(0.0f) : Rgb(1.0f, static_cast<float>(i), 0.0f);
    }
    InteractionList list;
    EXPECT_EQ(list.addPoints(points, irradiance), 67u);
    ASSERT_EQ(list.size(), 133u);
    list.pad();
    std::size_t place = 1;
    for (const InteractionList::Block& block : list.blocks())
        for (std::size_t k = 0; k < block.count; ++k, place += place % 3 == 1 ? 1 : 2) {
            EXPECT_EQ(block.x[k], static_cast<float>(place));
            EXPECT_EQ(block.flux[k][1], 2.0f * static_cast<float>(place));
        }
}

TEST(Accumulate, ListsCanBeUsedAgain) {
    InteractionList list = randomList(300, 1, true);
    list.clear();
    EXPECT_EQ(list.size(), 0u);
    EXPECT_TRUE(list.blocks().empty());
    addPoint(list, {1, 2, 3}, Rgb(1.0f));
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
// second. Where colours lie apart it is one order less each: their second moments differ.
void expectOrders(bool isColoured) {
    const ChannelMedium medium{0, 1, 0, 1.3};  // no absorption: power laws
    const auto profile = makeProfile("dipole", medium);
    const KernelTable table({profile.get(), profile.get(), profile.get()}, 1e4, 0.1);
    Rng rng(21);
    std::vector<SurfacePoint> points;
    std::vector<Rgb> irradiance;
    for (int i = 0; i < 100; ++i) {
        SurfacePoint p;
        p.position =
            Vec3(rng.uniform() * rng.uniform(), rng.uniform(), 0.5f * rng.uniform()) * 20.0f;
        p.areaMm2 = 0.5f + rng.uniform();
        points.push_back(p);
        const float e = rng.uniform();
        irradiance.emplace_back(e, isColoured ? 0.05f * p.position.x : e,
                                isColoured ? 0.05f * p.position.y : e);
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
            list.setNodes(nodes, std::vector<std::uint32_t>{0});
            list.pad();
            std::vector<DRgb> result(1, DRgb(0));
            accumulateScalar(table, list, withMoments, at, result);
            const DRgb miss = result[0] / sum.bruteForce(at[0]) - 1.0;
            worst = std::max(worst, maxComponent(glm::abs(miss)));
        }
        return worst;
    };
    const double withMoments = isColoured ? 4 : 8, without = isColoured ? 2 : 4;
    for (const float distance : {50.0f, 100.0f, 200.0f}) {
        if (isColoured && distance < 100) continue;  // the third order still shows
        EXPECT_NEAR(errorAt(distance, true) / errorAt(2 * distance, true), withMoments,
                    0.31 * withMoments)
            << distance;
        EXPECT_NEAR(errorAt(distance, false) / errorAt(2 * distance, false), without,
                    0.25 * without)
            << distance;
    }
    EXPECT_LT(errorAt(100, true), 0.2 * errorAt(100, false));
}

TEST(Accumulate, SecondMomentsLeaveOutTheThirdOrder) { expectOrders(false); }
TEST(Accumulate, LeansLeaveOutTheSecondOrderOfColour) { expectOrders(true); }

}  // namespace
}  // namespace sss
