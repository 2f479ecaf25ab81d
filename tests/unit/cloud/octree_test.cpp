#include "sss/cloud/octree.h"

#include "sss/base/rng.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

namespace sss {
namespace {

struct Cloud {
    std::vector<SurfacePoint> points;
    std::vector<Rgb> irradiance;

    void add(const Vec3& position, float area, const Rgb& e) {
        SurfacePoint p;
        p.position = position;
        p.areaMm2 = area;
        points.push_back(p);
        irradiance.push_back(e);
    }
    Cloud sorted() const {
        Cloud result;
        for (const std::uint32_t i : cloudOrder(view())) {
            result.points.push_back(points[i]);
            result.irradiance.push_back(irradiance[i]);
        }
        return result;
    }
    CloudView view() const { return {points, irradiance}; }
};

Cloud randomCloud(std::size_t count, std::uint64_t seed) {
    Rng rng(seed);
    Cloud cloud;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 p{rng.uniform() * 30 - 10, rng.uniform() * 10, rng.uniform() * rng.uniform()};
        cloud.add(p, 0.5f + rng.uniform(),
                  {rng.uniform(), 2 * rng.uniform(), 0.01f * rng.uniform()});
    }
    return cloud.sorted();
}

// Everything that holds for any octree over any cloud.
void expectSound(const Cloud& cloud, const std::vector<OctreeNode>& nodes) {
    ASSERT_FALSE(nodes.empty());
    EXPECT_LT(nodes.size(), 2 * cloud.points.size() + 1);
    std::vector<int> owners(cloud.points.size(), 0);
    std::vector<int> parents(nodes.size(), 0);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const OctreeNode& node = nodes[n];
        const auto expectInside = [&](const Vec3& place, float more) {
            ASSERT_LE(glm::length(DVec3(place) - DVec3(node.centroid)) - more, node.radius);
        };
        ASSERT_TRUE(isFinite(node.centroid) && isFinite(node.flux));
        ASSERT_GT(node.size(), 0u);
        if (node.isLeaf()) {
            for (std::uint32_t i = node.first; i < node.first + node.size(); ++i) {
                ASSERT_LT(i, cloud.points.size());
                ++owners[i];
                expectInside(cloud.points[i].position, 0);
            }
            continue;
        }
        EXPECT_GE(node.size(), 2u);
        DRgb flux{0};
        double area = 0;
        for (std::uint32_t k = node.first; k < node.first + node.size(); ++k) {
            ASSERT_GT(k, n);
            ASSERT_LT(k, nodes.size());
            ++parents[k];
            flux += DRgb(nodes[k].flux);
            area += static_cast<double>(nodes[k].areaMm2);
            expectInside(nodes[k].centroid, nodes[k].radius);
        }
        EXPECT_NEAR(area, static_cast<double>(node.areaMm2), 2e-7 * area);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(flux[c], static_cast<double>(node.flux[c]), 2e-7 * flux[c]);
    }
    EXPECT_EQ(std::count(owners.begin(), owners.end(), 1), std::ssize(owners));
    EXPECT_EQ(std::count(parents.begin() + 1, parents.end(), 1), std::ssize(parents) - 1);
    EXPECT_EQ(parents[0], 0);
}

TEST(Octree, NodesAre96Bytes) { EXPECT_EQ(sizeof(OctreeNode), 96u); }

TEST(Octree, EmptyCloudHasNoNodes) {
    EXPECT_TRUE(buildOctree(CloudView{}).empty());
    EXPECT_TRUE(mortonOrder({}).empty());
}

TEST(Octree, RandomPoints) {
    for (const std::size_t count : {1u, 2u, 8u, 9u, 100u, 20000u}) {
        const Cloud cloud = randomCloud(count, count);
        const auto nodes = buildOctree(cloud.view());
        expectSound(cloud, nodes);
        for (const OctreeNode& n : nodes)
            if (n.isLeaf()) {
                ASSERT_LE(n.size(), kLeafPoints);
            }
        DRgb flux{0};
        for (std::size_t i = 0; i < count; ++i) flux += DRgb(cloud.view().flux(i));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(static_cast<double>(nodes[0].flux[c]), flux[c], 1e-6 * flux[c]);
    }
}

TEST(Octree, MomentsOfASmallNodeAreThoseOfItsPoints) {
    const Cloud cloud = randomCloud(8, 4);
    const auto nodes = buildOctree(cloud.view());
    ASSERT_EQ(nodes.size(), 1u);
    const OctreeNode& node = nodes[0];
    DVec3 centroid{0};
    double weight = 0;
    const auto mean = [&](std::size_t i) {
        const DRgb f(cloud.view().flux(i));
        return (f.x + f.y + f.z) / 3;
    };
    for (std::size_t i = 0; i < 8; ++i) {
        centroid += mean(i) * DVec3(cloud.points[i].position);
        weight += mean(i);
    }
    centroid /= weight;
    EXPECT_LT(glm::length(centroid - DVec3(node.centroid)), 1e-5);
    double xx = 0, yz = 0;
    std::array<double, 3> third{}, total{};
    std::array<DVec3, 3> offset{};
    for (std::size_t i = 0; i < 8; ++i) {
        const DVec3 d = DVec3(cloud.points[i].position) - centroid;
        xx += mean(i) * d.x * d.x / weight;
        yz += mean(i) * d.y * d.z / weight;
        for (std::size_t c = 0; c < 3; ++c) {
            const double f = cloud.view().flux(i)[static_cast<int>(c)];
            total[c] += f;
            third[c] += f * std::pow(glm::length(d), 3);
            offset[c] += f * d;
        }
    }
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, third[c] / total[c]);
    EXPECT_NEAR(static_cast<double>(node.moments[0]), xx, 1e-5 * xx);
    EXPECT_NEAR(static_cast<double>(node.moments[5]), yz, 1e-5 * xx);
    EXPECT_NEAR(std::pow(static_cast<double>(node.cubicMean), 3), largest, 1e-5 * largest);
    const double size = glm::length(offset[0]) / weight;
    EXPECT_LT(glm::length(DVec3(node.lean[0]) - offset[0] / weight), 1e-5 * size);
    EXPECT_LT(glm::length(DVec3(node.lean[1]) - offset[2] / weight), 1e-5 * size);
    EXPECT_LT(glm::length(offset[0] + offset[1] + offset[2]) / weight, 1e-5 * size);
    EXPECT_TRUE(node.isColoured());
}

TEST(Octree, LightOfOneColourLeansNowhere) {
    Cloud cloud = randomCloud(2000, 5);
    Rng rng(6);
    for (Rgb& e : cloud.irradiance) e = Rgb(0.9f, 0.7f, 0.1f) * rng.uniform();
    for (const OctreeNode& node : buildOctree(cloud.view()))
        for (const Vec3& lean : node.lean) EXPECT_LE(glm::length(lean), 1e-6f * node.radius);
    for (Rgb& e : cloud.irradiance) e = Rgb(rng.uniform());
    for (const OctreeNode& node : buildOctree(cloud.view())) EXPECT_FALSE(node.isColoured());
}

TEST(Octree, SameNodesInAnyOrderOfTheInput) {
    Cloud cloud = randomCloud(5000, 6);
    const auto expected = buildOctree(cloud.view());
    Rng rng(8);
    for (std::size_t i = cloud.points.size(); i-- > 1;) {
        const std::size_t j = rng.next64() % (i + 1);
        std::swap(cloud.points[i], cloud.points[j]);
        std::swap(cloud.irradiance[i], cloud.irradiance[j]);
    }
    const auto nodes = buildOctree(cloud.sorted().view());
    ASSERT_EQ(nodes.size(), expected.size());
    EXPECT_EQ(std::memcmp(nodes.data(), expected.data(), nodes.size() * sizeof(OctreeNode)), 0);
}

TEST(Octree, CoincidentPointsShareALeaf) {
    Cloud cloud;
    for (int i = 0; i < 1000; ++i) cloud.add({1, 2, 3}, 0.25f, Rgb(1.0f));
    auto nodes = buildOctree(cloud.sorted().view());
    expectSound(cloud, nodes);
    ASSERT_EQ(nodes.size(), 1u);
    EXPECT_FLOAT_EQ(nodes[0].flux.x, 250.0f);
    EXPECT_EQ(nodes[0].radius, 0.0f);

    // With others around them.
    for (int i = 0; i < 50; ++i) cloud.add({0.1f * static_cast<float>(i), 2, 3}, 1.0f, Rgb(2.0f));
    const Cloud mixed = cloud.sorted();
    expectSound(mixed, buildOctree(mixed.view()));
}

TEST(Octree, CollinearAndCoplanarPointsTerminate) {
    Cloud line, plane, tiny;
    for (int i = 0; i < 1000; ++i) {
        const auto x = static_cast<float>(i);
        line.add({0, x * 0.01f, 0}, 1.0f, Rgb(1.0f));
        plane.add({static_cast<float>(i % 32), static_cast<float>(i / 32), 5}, 1.0f, Rgb(1.0f));
        tiny.add(Vec3(1e6f, x * 1e-30f, 0), 1.0f, Rgb(1.0f));
    }
    for (const Cloud& cloud : {line.sorted(), plane.sorted(), tiny.sorted()})
        expectSound(cloud, buildOctree(cloud.view()));
}

TEST(Octree, DarkCloudHasCentroidsByArea) {
    Cloud cloud;
    for (int i = 0; i < 100; ++i)
        cloud.add({static_cast<float>(i), 0, 0}, i == 99 ? 99.0f : 1.0f, Rgb(0.0f));
    const auto nodes = buildOctree(cloud.sorted().view());
    expectSound(cloud.sorted(), nodes);
    EXPECT_NEAR(static_cast<double>(nodes[0].centroid.x), (4851.0 + 99 * 99) / 198, 1e-4);
    EXPECT_EQ(nodes[0].flux, Rgb(0.0f));
    EXPECT_EQ(nodes[0].cubicMean, 0.0f);
}

TEST(Octree, OneBrightPointAmongDarkOnes) {
    Cloud cloud = randomCloud(100000, 12);
    std::fill(cloud.irradiance.begin(), cloud.irradiance.end(), Rgb(0.0f));
    cloud.irradiance[34567] = {0, 3, 0};
    const auto nodes = buildOctree(cloud.view());
    const SurfacePoint& bright = cloud.points[34567];
    std::size_t lit = 0;
    for (const OctreeNode& node : nodes) {
        if (isZero(node.flux)) continue;
        ++lit;
        EXPECT_EQ(node.centroid, bright.position);
        EXPECT_FLOAT_EQ(node.flux.y, 3 * bright.areaMm2);
        EXPECT_EQ(node.cubicMean, 0.0f);
    }
    EXPECT_GT(lit, 4u);
    EXPECT_LT(lit, 22u);
    EXPECT_LT(nodes.size(), cloud.points.size());
}

TEST(Octree, PointsAtOnePlaceAreOrderedByWhatIsInThem) {
    // Many on few places, all different otherwise: the order in which they come must not show.
    for (const std::size_t count : {2u, 8u, 9u, 300u}) {
        Rng rng(count);
        Cloud cloud;
        for (std::size_t i = 0; i < count; ++i)
            cloud.add({static_cast<float>(i % 3), 0, static_cast<float>(i % 2)}, rng.uniform(),
                      {rng.uniform(), rng.uniform(), rng.uniform()});
        const Cloud sorted = cloud.sorted();
        std::ranges::reverse(cloud.points);
        std::ranges::reverse(cloud.irradiance);
        const Cloud other = cloud.sorted();
        EXPECT_EQ(sorted.irradiance, other.irradiance);
        const auto nodes = buildOctree(sorted.view()), otherNodes = buildOctree(other.view());
        ASSERT_EQ(nodes.size(), otherNodes.size());
        EXPECT_EQ(std::memcmp(nodes.data(), otherNodes.data(), nodes.size() * sizeof(OctreeNode)),
                  0);
    }
    // The same place, area and normal: by the irradiance, if it is given.
    for (const float first : {1.0f, 2.0f}) {
        Cloud pair;
        pair.add({1, 2, 3}, 1, Rgb(first));
        pair.add({1, 2, 3}, 1, Rgb(3.0f - first));
        EXPECT_EQ(pair.sorted().irradiance, (std::vector<Rgb>{Rgb(2.0f), Rgb(1.0f)}));
        EXPECT_EQ(cloudOrder({pair.points, {}}), (std::vector<std::uint32_t>{0, 1}));
    }
}

TEST(Octree, EqualPointsKeepTheirOrder) {
    const std::vector<Vec3> positions{{1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {2, 2, 2}};
    EXPECT_EQ(mortonOrder(positions), (std::vector<std::uint32_t>{1, 3, 0, 2, 4}));
}

}  // namespace
}  // namespace sss
