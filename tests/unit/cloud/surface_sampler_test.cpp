#include "sss/cloud/surface_sampler.h"

#include "sss/base/parallel.h"
#include "sss/base/rng.h"
#include "sss/cloud/dart_throwing.h"
#include "sss/cloud/nearest_points.h"
#include "sss/geom/shapes.h"

#include <gtest/gtest.h>

#include <cstring>

namespace sss {
namespace {

std::vector<SurfacePoint> samplePoints(const TriangleMesh& mesh, double spacing,
                                       std::uint64_t seed = 0) {
    return sampleSurface(mesh, {.spacingMm = spacing, .seed = seed}).points;
}

bool sameBytes(const std::vector<SurfacePoint>& a, const std::vector<SurfacePoint>& b) {
    return a.size() == b.size() &&
           std::memcmp(a.data(), b.data(), a.size() * sizeof(SurfacePoint)) == 0;
}

DVec3 placeOf(const TriangleMesh& mesh, const SurfacePoint& p) {
    return mesh.positionAt(p.face, DVec2(p.barycentrics()));
}

// What holds for the points of any mesh.
void expectSound(const TriangleMesh& mesh, const std::vector<SurfacePoint>& points,
                 double spacing) {
    double area = 0;
    for (const SurfacePoint& p : points) {
        area += static_cast<double>(p.areaMm2);
        ASSERT_GT(p.areaMm2, 0.0f);
        ASSERT_LT(p.face, mesh.faceCount());
        ASSERT_LE(int{p.u} + int{p.v}, 65535);
        ASSERT_LT(glm::length(placeOf(mesh, p) - DVec3(p.position)), spacing);
        ASSERT_NEAR(glm::length(decodeUnitVector(p.normal)), 1.0f, 1e-5f);
    }
    EXPECT_NEAR(area / mesh.area(), 1.0, 1e-6);
}

TEST(SurfaceSampler, AreasSumAndPointsLieOnTheirFaces) {
    const TriangleMesh sphere = makeSphere(5);
    expectSound(sphere, samplePoints(sphere, 0.4), 0.4);
    const TriangleMesh box = makeBox({8, 3, 5});
    expectSound(box, samplePoints(box, 0.4), 0.4);
    for (const SurfacePoint& p : samplePoints(sphere, 0.4))
        ASSERT_GT(glm::dot(decodeUnitVector(p.normal), glm::normalize(p.position)), 0.97f);
}

TEST(SurfaceSampler, CountIsAsExpected) {
    for (const TriangleMesh& mesh : {makeRectangle(40, 40), makeSphere(10), makeBox(DVec3(15))}) {
        const SamplerOptions options{.spacingMm = 0.5};
        const auto expected = static_cast<double>(expectedPointCount(mesh.area(), options));
        const auto count = static_cast<double>(sampleSurface(mesh, options).size());
        EXPECT_NEAR(count / expected, 1.0, 0.03);
    }
}

TEST(DartThrowing, KeepsItsDistanceAndCoversEverything) {
    Rng rng(2);
    std::vector<Vec3> positions, normals;
    for (int i = 0; i < 6000; ++i) {
        // A sheet with two sides, 0.02 apart, and a ball.
        const bool ball = i % 3 == 0;
        const float phi = 2 * kPiF * rng.uniform(), z = 2 * rng.uniform() - 1;
        const float s = std::sqrt(1 - z * z);
        const Vec3 onBall{s * std::cos(phi), s * std::sin(phi), z};
        const bool up = i % 2 == 0;
        positions.push_back(ball ? onBall
                                 : Vec3(4 + 3 * rng.uniform(), 3 * rng.uniform(), up ? 0.02f : 0));
        normals.push_back(ball ? onBall : Vec3(0, 0, up ? 1 : -1));
    }
    constexpr float kRadius = 0.25f;
    const DartThrow darts = throwDarts(positions, normals, kRadius, 99);
    ASSERT_GT(darts.chosen.size(), 100u);
    EXPECT_TRUE(std::is_sorted(darts.chosen.begin(), darts.chosen.end()));
    const auto near = [&](std::uint32_t a, std::uint32_t b) {
        return glm::length(positions[a] - positions[b]) < kRadius * (1 - 1e-6f) &&
               glm::dot(normals[a], normals[b]) > 0;
    };
    for (std::size_t i = 0; i < darts.chosen.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) ASSERT_FALSE(near(darts.chosen[i], darts.chosen[j]));
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const std::uint32_t blocker = darts.blocker[i];
        ASSERT_LT(blocker, positions.size());
        ASSERT_EQ(darts.blocker[blocker], blocker) << "covered by one that was not chosen";
        ASSERT_LT(glm::length(positions[i] - positions[blocker]), kRadius * (1 + 1e-6f));
        ASSERT_GT(glm::dot(normals[i], normals[blocker]), 0.0f);
    }
    EXPECT_NE(throwDarts(positions, normals, kRadius, 100).chosen, darts.chosen);
}

TEST(DartThrowing, CoincidentCandidatesGiveOne) {
    const std::vector<Vec3> positions(5000, Vec3(1, 2, 3)), normals(5000, Vec3(0, 1, 0));
    EXPECT_EQ(throwDarts(positions, normals, 0.1, 1).chosen.size(), 1u);
    EXPECT_TRUE(throwDarts({}, {}, 0.1, 1).chosen.empty());
}

TEST(NearestPoints, AgreesWithBruteForce) {
    Rng rng(4);
    std::vector<Vec3> points, queries;
    for (int i = 0; i < 700; ++i) points.emplace_back(rng.uniform(), rng.uniform(), rng.uniform());
    for (int i = 0; i < 300; ++i) queries.emplace_back(rng.uniform(), rng.uniform(), rng.uniform());
    constexpr std::size_t kCount = 5;
    std::vector<std::uint32_t> found(queries.size() * kCount);
    NearestPoints(points).query(queries, kCount, found);
    for (std::size_t q = 0; q < queries.size(); ++q) {
        const auto squared = [&](const Vec3& p) {
            return glm::dot(p - queries[q], p - queries[q]);
        };
        std::vector<float> d;
        for (const Vec3& p : points) d.push_back(squared(p));
        std::sort(d.begin(), d.end());
        for (std::size_t k = 0; k < kCount; ++k)
            ASSERT_FLOAT_EQ(squared(points[found[q * kCount + k]]), d[k]);
    }
}

TEST(SurfaceSampler, ThinSheetIsSampledOnBothSides) {
    const double thickness = 0.02, spacing = 0.3;
    const TriangleMesh sheet = makeBox({10, 10, thickness});
    const auto points = samplePoints(sheet, spacing);
    expectSound(sheet, points, spacing);
    double top = 0, bottom = 0;
    for (const SurfacePoint& p : points) {
        const float z = decodeUnitVector(p.normal).z;
        if (z > 0.9f) top += static_cast<double>(p.areaMm2);
        if (z < -0.9f) bottom += static_cast<double>(p.areaMm2);
    }
    EXPECT_NEAR(top, 100, 1.5);
    EXPECT_NEAR(bottom, 100, 1.5);
}

TEST(SurfaceSampler, CoarseTrianglesAreSampledAsDenselyAsFineOnes) {
    const auto coarse = samplePoints(makeBox(DVec3(10)), 0.4);
    const auto fine = samplePoints(makeBox(DVec3(10), 0.3), 0.4);
    EXPECT_NEAR(double(coarse.size()) / double(fine.size()), 1.0, 0.06);
    // And as evenly: no cell is far larger than the mean one.
    for (const auto& points : {coarse, fine}) {
        double largest = 0, squares = 0;
        for (const SurfacePoint& p : points) {
            largest = std::max(largest, static_cast<double>(p.areaMm2));
            squares += static_cast<double>(p.areaMm2) * static_cast<double>(p.areaMm2);
        }
        const double mean = 600.0 / double(points.size());
        EXPECT_LT(largest, 2.2 * mean);
        EXPECT_LT(std::sqrt(squares / double(points.size()) - mean * mean), 0.25 * mean);
    }
}

TEST(SurfaceSampler, PointsAreAFunctionOfTheSeed) {
    const TriangleMesh mesh = makeCylinder(3, 8);
    const auto points = samplePoints(mesh, 0.3, 5);
    EXPECT_TRUE(sameBytes(points, samplePoints(mesh, 0.3, 5)));
    EXPECT_FALSE(sameBytes(points, samplePoints(mesh, 0.3, 6)));
}

TEST(SurfaceSampler, SameBytesWithAnyNumberOfThreads) {
    const TriangleMesh mesh = makeSphere(4);
    std::vector<SurfacePoint> one, two;
    {
        const ThreadLimit limit(1);
        one = samplePoints(mesh, 0.25);
    }
    {
        const ThreadLimit limit(2);
        two = samplePoints(mesh, 0.25);
    }
    ASSERT_GT(one.size(), 2500u);
    EXPECT_TRUE(sameBytes(one, two));
}

TEST(SurfaceSampler, OneTriangle) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {3, 0, 0}, {0, 2, 1}};
    mesh.faces = {{0, 1, 2}};
    expectSound(mesh, samplePoints(mesh, 0.1), 0.1);
}

TEST(SurfaceSampler, BodySmallerThanTheSpacingGetsTheFewest) {
    const TriangleMesh mesh = makeSphere(0.01);
    const SamplerOptions options{.spacingMm = 1};
    EXPECT_EQ(expectedPointCount(mesh.area(), options), options.fewestPoints);
    const auto points = sampleSurface(mesh, options).points;
    expectSound(mesh, points, 0.005);
    EXPECT_NEAR(double(points.size()), double(options.fewestPoints), 0.15 * 256);
}

TEST(SurfaceSampler, SizesFarFromOneMillimetre) {
    for (const double scale : {1e-6, 1e6}) {
        const TriangleMesh mesh = makeBox(DVec3(scale));
        const auto points = samplePoints(mesh, 0.05 * scale);
        expectSound(mesh, points, 0.05 * scale);
        EXPECT_NEAR(double(points.size()), 2400, 200);
    }
}

TEST(SurfaceSampler, NeedleTriangles) {
    // A strip of slivers, a million times as long as wide, beside a square.
    TriangleMesh mesh = makeRectangle(4, 4);
    for (int i = 0; i < 20; ++i) {
        const auto v = static_cast<std::uint32_t>(mesh.positions.size());
        const double y = 2 + i * 1e-5;
        mesh.positions.insert(mesh.positions.end(), {{-5, y, 0}, {5, y, 0}, {5, y + 1e-5, 0}});
        mesh.faces.emplace_back(v, v + 1, v + 2);
    }
    mesh.normals.clear();
    const auto points = samplePoints(mesh, 0.1);
    expectSound(mesh, points, 0.1);
    EXPECT_NEAR(double(points.size()), 1600, 100);
}

// The cells of a deforming surface are made of the same parts of the same faces.
TEST(CarriedSamples, KeepTheirPlacesOnTheFaces) {
    const TriangleMesh sphere = makeSphere(10);
    SamplerOptions options;
    options.spacingMm = 2;
    const SurfaceSamples placed = sampleSurface(sphere, options);
    const SurfaceSamples same = carrySamples(placed, sphere, sphere);
    TriangleMesh twice = sphere, stretched = sphere;
    for (DVec3& p : twice.positions) p *= 2.0;
    for (DVec3& p : stretched.positions) p *= DVec3(1, 3, 0.5);
    const SurfaceSamples scaled = carrySamples(placed, sphere, twice);
    const SurfaceSamples carried = carrySamples(placed, sphere, stretched);
    EXPECT_FALSE(carried.inMortonOrder);
    ASSERT_EQ(carried.size(), placed.size());
    double area = 0;
    for (std::size_t p = 0; p < placed.size(); ++p) {
        EXPECT_EQ(same.points[p].position, placed.points[p].position);
        EXPECT_EQ(same.points[p].areaMm2, placed.points[p].areaMm2);
        EXPECT_LT(glm::distance(scaled.points[p].position, placed.points[p].position * 2.0f),
                  1e-5f);
        EXPECT_FLOAT_EQ(scaled.points[p].areaMm2, placed.points[p].areaMm2 * 4);
        // Within the cell, as it is now: no further from its anchor's new place than from the
        // old one, times the largest stretch.
        const SurfacePoint& point = carried.points[p];
        const DVec3 anchor = stretched.positionAt(point.face, DVec2(point.barycentrics()));
        EXPECT_LT(glm::distance(DVec3(point.position), anchor), 3 * options.spacingMm);
        area += static_cast<double>(point.areaMm2);
    }
    EXPECT_NEAR(area / stretched.area(), 1, 1e-5);
}

}  // namespace
}  // namespace sss
