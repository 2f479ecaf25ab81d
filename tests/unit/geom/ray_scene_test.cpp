#include "sss/geom/ray_scene.h"

#include "geom_tools.h"
#include "sss/base/parallel.h"
#include "sss/geom/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace sss {
namespace {

using testing::randomDirection;

/// A mesh in float, as a scene takes it.
struct FloatMesh {
    explicit FloatMesh(const TriangleMesh& mesh, const Vec3& by = Vec3{0}) : faces(mesh.faces) {
        for (const DVec3& p : mesh.positions) positions.push_back(Vec3(p) + by);
    }
    RayScene::Geometry geometry(std::uint32_t mask = kAllGeometry) const {
        return {positions, faces, mask};
    }
    std::vector<Vec3> positions;
    std::vector<UVec3> faces;
};

RayScene sceneOf(const FloatMesh& mesh) {
    const std::vector<RayScene::Geometry> list{mesh.geometry()};
    return RayScene(list);
}

Ray towards(const Vec3& from, const Vec3& to) { return {from, glm::normalize(to - from)}; }

// Every line that enters a closed mesh leaves it as often, through other faces; the nearest of its
// hits is the one that intersect() finds, and the next one what it finds behind.
TEST(RayScene, ForEachHitMeetsThemAll) {
    const FloatMesh sphere(makeSphere(10)), box(makeBox({4, 3, 50}), Vec3(20, 0, 0));
    const std::vector<RayScene::Geometry> list{sphere.geometry(1), box.geometry(2)};
    const RayScene scene(list);
    Rng rng(5);
    int most = 0;
    for (int i = 0; i < 5000; ++i) {
        const Ray ray = towards(randomDirection(rng) * 60.0f, randomDirection(rng) * 20.0f);
        std::vector<Hit> hits;
        scene.forEachHit(ray, [&](const Hit& hit) { hits.push_back(hit); });
        std::ranges::sort(hits, {}, &Hit::t);
        ASSERT_EQ(hits.size() % 2, 0u);
        most = std::max(most, static_cast<int>(hits.size()));
        Hit nearest;
        ASSERT_EQ(scene.intersect(ray, nearest), !hits.empty());
        if (hits.empty()) continue;
        EXPECT_EQ(hits[0].t, nearest.t);
        EXPECT_EQ(hits[0].face, nearest.face);
        EXPECT_EQ(hits[0].normal, nearest.normal);
        Ray behind = ray;
        behind.tMin = std::nextafter(hits[0].t, 1e9f);
        ASSERT_TRUE(scene.intersect(behind, nearest));
        EXPECT_EQ(hits[1].t, nearest.t);
        for (std::size_t k = 1; k < hits.size(); ++k)
            EXPECT_FALSE(hits[k].geometry == hits[k - 1].geometry &&
                         hits[k].face == hits[k - 1].face);
        std::size_t ofTheBox = 0, inTheBox = 0;
        scene.forEachHit(
            ray, [&](const Hit&) { ++ofTheBox; }, 2);
        for (const Hit& hit : hits) inTheBox += hit.geometry;
        EXPECT_EQ(ofTheBox, inTheBox);
    }
    EXPECT_EQ(most, 4);
}

TEST(RayScene, HitsASphereWhereTheFormulaSays) {
    const float radius = 10;
    const FloatMesh sphere(makeSphere(radius));
    const RayScene scene = sceneOf(sphere);
    Rng rng(11);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 target = randomDirection(rng) * (radius * 1.5f * rng.uniform());
        const Ray ray = towards(randomDirection(rng) * 40.0f, target);
        const DVec3 o(ray.origin), d(ray.direction);
        const double b = glm::dot(o, d), c = glm::dot(o, o) - double(radius) * radius;
        const double discriminant = b * b - c;
        Hit hit;
        const bool found = scene.intersect(ray, hit);
        EXPECT_EQ(found, scene.occluded(ray));
        // Near the silhouette the facets, 1e-4 inside, may be missed.
        if (std::abs(discriminant) < 0.05) continue;
        ASSERT_EQ(found, discriminant > 0);
        if (!found) continue;
        ++hits;
        const double expected = -b - std::sqrt(discriminant);
        const double cosine = std::sqrt(discriminant) / radius;
        ASSERT_NEAR(hit.t, expected, 1.3e-4 * radius / cosine);
        ASSERT_NEAR(glm::distance(scene.position(hit), ray.at(hit.t)), 0, 2e-5 / cosine);
        const Vec3 normal = glm::normalize(scene.position(hit));
        ASSERT_GT(glm::dot(normal, hit.normal), 0.9998f);
        ASSERT_NEAR(glm::length(hit.normal), 1, 1e-6f);
    }
    EXPECT_GT(hits, 8000);
}

/// Nearest hit by Moeller and Trumbore in double, over all triangles.
std::optional<double> bruteForce(const FloatMesh& mesh, const Ray& ray) {
    std::optional<double> nearest;
    const DVec3 o(ray.origin), d(ray.direction);
    for (const UVec3& f : mesh.faces) {
        const DVec3 a(mesh.positions[f.x]), e1 = DVec3(mesh.positions[f.y]) - a,
                                            e2 = DVec3(mesh.positions[f.z]) - a;
        const DVec3 p = glm::cross(d, e2);
        const double det = glm::dot(e1, p);
        if (det == 0) continue;
        const DVec3 s = o - a, q = glm::cross(s, e1);
        const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det;
        const double t = glm::dot(e2, q) / det;
        if (u < 0 || v < 0 || u + v > 1 || t <= double(ray.tMin) || t >= double(ray.tMax)) continue;
        if (!nearest || t < *nearest) nearest = t;
    }
    return nearest;
}

TEST(RayScene, AgreesWithBruteForceOnATriangleSoup) {
    Rng rng(12);
    TriangleMesh soup;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const DVec3 centre = DVec3(randomDirection(rng)) * (10.0 * rng.uniformDouble());
        for (int c = 0; c < 3; ++c)
            soup.positions.push_back(centre + DVec3(randomDirection(rng)) * rng.uniformDouble());
        soup.faces.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    const FloatMesh mesh(soup);
    const RayScene scene = sceneOf(mesh);
    int hits = 0, differences = 0;
    for (int i = 0; i < 1000; ++i) {
        Ray ray = towards(randomDirection(rng) * 15.0f, randomDirection(rng) * 5.0f);
        ray.tMin = 5 * rng.uniform();
        if (i % 2 == 0) ray.tMax = 5 + 15 * rng.uniform();
        const std::optional<double> expected = bruteForce(mesh, ray);
        Hit hit;
        const bool found = scene.intersect(ray, hit);
        ASSERT_EQ(found, scene.occluded(ray));
        // A ray through an edge may be decided either way by float and double.
        if (found != expected.has_value() ||
            (found && std::abs(hit.t - *expected) > 1e-4 * *expected)) {
            ++differences;
            continue;
        }
        hits += found ? 1 : 0;
        if (!found) continue;
        const UVec3 f = mesh.faces[hit.face];
        const Vec3 cross = glm::cross(mesh.positions[f.y] - mesh.positions[f.x],
                                      mesh.positions[f.z] - mesh.positions[f.x]);
        ASSERT_GT(glm::dot(glm::normalize(cross), hit.normal), 0.9999f);
    }
    EXPECT_GT(hits, 300);
    EXPECT_LE(differences, 1);
}

TEST(RayScene, NoRaySlipsThroughASharedEdge) {
    const FloatMesh sphere(makeSphere(10));
    const RayScene scene = sceneOf(sphere);
    Rng rng(13);
    std::size_t throughVertices = 0;
    for (const UVec3& f : sphere.faces) {
        const Vec3 a = sphere.positions[f.x], b = sphere.positions[f.y];
        const Vec3 inside = randomDirection(rng) * (5 * rng.uniform());
        const Vec3 onEdge = a + (b - a) * (0.01f + 0.98f * rng.uniform());
        ASSERT_TRUE(scene.occluded(towards(inside, onEdge)));
        throughVertices += scene.occluded(towards(inside, a)) ? 0 : 1;
    }
    EXPECT_LT(throughVertices, sphere.faces.size() / 50);
}

TEST(RayScene, SeparatesGeometriesAndMasks) {
    const FloatMesh nearer(makeRectangle(2, 2), {0, 0, 2}), farther(makeRectangle(2, 2));
    const FloatMesh none{TriangleMesh{}};
    const std::vector<RayScene::Geometry> list{none.geometry(), farther.geometry(1),
                                               nearer.geometry(2)};
    const RayScene scene(list);
    const Ray ray{{0.3f, 0.2f, 10}, {0, 0, -1}};
    Hit hit;
    ASSERT_TRUE(scene.intersect(ray, hit));
    EXPECT_EQ(hit.geometry, 2u);
    EXPECT_FLOAT_EQ(hit.t, 8);
    EXPECT_EQ(hit.normal, (Vec3{0, 0, 1}));
    ASSERT_TRUE(scene.intersect(ray, hit, 1));
    EXPECT_EQ(hit.geometry, 1u);
    EXPECT_FLOAT_EQ(hit.t, 10);
    EXPECT_FALSE(scene.intersect(ray, hit, 4));
    EXPECT_FALSE(scene.occluded(ray, 4));
    EXPECT_TRUE(scene.occluded(ray, 2));
    // From behind, the normal still follows the winding.
    ASSERT_TRUE(scene.intersect({{0, 0, -5}, {0, 0, 1}}, hit));
    EXPECT_EQ(hit.normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(scene.bounds().lo, (Vec3{-1, -1, 0}));
    EXPECT_EQ(scene.bounds().hi, (Vec3{1, 1, 2}));
}

TEST(RayScene, AnEmptySceneIsNeverHit) {
    const RayScene scene{std::span<const RayScene::Geometry>{}};
    Hit hit;
    EXPECT_FALSE(scene.intersect({{0, 0, 0}, {0, 0, 1}}, hit));
    EXPECT_FALSE(scene.occluded({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_TRUE(scene.bounds().isEmpty());
}

TEST(RayScene, TheHitFaceOnASharedEdgeDoesNotDependOnThreads) {
    const FloatMesh sphere(makeSphere(10));
    std::vector<std::uint32_t> faces[2];
    for (unsigned threads = 1; threads <= 2; ++threads) {
        const ThreadLimit limit(threads);
        const RayScene scene = sceneOf(sphere);
        for (const UVec3& f : sphere.faces) {
            Hit hit;
            const Vec3 a = sphere.positions[f.x], b = sphere.positions[f.y];
            for (const Vec3& target : {(a + b) * 0.5f, a * 0.75f + b * 0.25f}) {
                ASSERT_TRUE(scene.intersect(towards(target * 3.0f, target), hit));
                faces[threads - 1].push_back(hit.face);
            }
        }
    }
    EXPECT_EQ(faces[0], faces[1]);
}

struct Sphere {
    Vec3 centre;
    float radius;
};

/// Rays that leave a convex body into the outer half space, from where they first met it.
template <typename Leave>
int selfHits(const RayScene& scene, const Sphere& sphere, int rays, const Leave& leave) {
    const auto& [centre, radius] = sphere;
    Rng rng(14);
    int count = 0;
    for (int i = 0; i < rays; ++i) {
        const Vec3 target = centre + randomDirection(rng) * (0.9f * radius * rng.uniform());
        const Ray ray = towards(centre + randomDirection(rng) * (4 * radius), target);
        Hit hit;
        if (!scene.intersect(ray, hit)) return -1;
        Vec3 direction = randomDirection(rng);
        if (glm::dot(direction, hit.normal) < 0) direction = -direction;
        count += scene.occluded({leave(ray, hit), direction}) ? 1 : 0;
    }
    return count;
}

TEST(OffsetFromSurface, NeverHitsTheSphereItLeaves) {
    const auto leave = [](const Ray& ray, const Hit& hit) {
        return offsetFromSurface(ray.at(hit.t), hit.normal);
    };
    for (const Vec3 centre : {Vec3{0}, Vec3{100, -50, 3}, Vec3{2000, 1000, 0}})
        for (const float radius : {1.0f, 25.0f, 500.0f}) {
            const FloatMesh sphere(makeSphere(radius), centre);
            const int rays = radius == 25.0f ? 100000 : 20000;
            EXPECT_EQ(selfHits(sceneOf(sphere), {centre, radius}, rays, leave), 0)
                << centre.x << " " << radius;
        }
}

TEST(RayScene, LeaveNeverHitsTheSphereAtAnyScale) {
    for (const float radius : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f})
        for (const Vec3 centre : {Vec3{0}, Vec3{30, -10, 3} * radius}) {
            const FloatMesh sphere(makeSphere(radius), centre);
            const RayScene scene = sceneOf(sphere);
            const auto leave = [&](const Ray&, const Hit& hit) {
                return scene.leave(hit, hit.normal);
            };
            EXPECT_EQ(selfHits(scene, {centre, radius}, 20000, leave), 0)
                << centre.x << " " << radius;
        }
}

TEST(RayScene, LeaveHoldsOnALargeTiltedPlaneThroughTheOrigin) {
    TriangleMesh plane = makeRectangle(2000, 2000);
    for (DVec3& p : plane.positions) p = {0.8 * p.x, p.y, 0.6 * p.x};
    const FloatMesh mesh(plane);
    const RayScene scene = sceneOf(mesh);
    Rng rng(15);
    for (int i = 0; i < 100000; ++i) {
        const Vec3 target =
            Vec3{0.8f, 0, 0.6f} * (2 * rng.uniform() - 1) + Vec3{0, 2 * rng.uniform() - 1, 0};
        Hit hit;
        ASSERT_TRUE(scene.intersect(towards({-50, 20, 130}, target), hit));
        Vec3 direction = randomDirection(rng);
        if (glm::dot(direction, hit.normal) < 0) direction = -direction;
        ASSERT_FALSE(scene.occluded({scene.leave(hit, hit.normal), direction}));
    }
}

TEST(RayScene, RaysTogetherHitWhatTheyHitAlone) {
    constexpr std::uint32_t kOne = 2, kOther = 4;
    const FloatMesh inner(makeSphere(6)), outer(makeSphere(10));
    const std::array geometries{RayScene::Geometry{inner.positions, inner.faces, kOne},
                                RayScene::Geometry{outer.positions, outer.faces, kOther}};
    const RayScene scene(geometries);
    Rng rng(5);
    int hits = 0, occluded = 0;
    for (int bundle = 0; bundle < 300; ++bundle) {
        const std::size_t count = 1 + static_cast<std::size_t>(bundle % 21);
        const Vec3 from = randomDirection(rng) * 40.0f, to = randomDirection(rng) * 11.0f;
        std::vector<Ray> rays;
        std::vector<std::uint32_t> masks;
        for (std::size_t i = 0; i < count; ++i) {
            rays.push_back(towards(from, to + 0.5f * randomDirection(rng)));
            if (i % 3 == 0) rays.back().tMax = 35;
            if (bundle % 2 == 0) masks.push_back(i % 2 == 0 ? kOne : kOne | kOther);
        }
        const auto together =
            bundle % 3 == 0 ? RayScene::Together::Parted : RayScene::Together::Parallel;
        std::vector<Hit> found(count);
        scene.intersectTogether(rays, together, found, masks);
        std::array<bool, 21> blocked;
        scene.occludedTogether(rays, together, blocked, masks);
        for (std::size_t i = 0; i < count; ++i) {
            Hit alone;
            const bool isHit =
                scene.intersect(rays[i], alone, masks.empty() ? kAllGeometry : masks[i]);
            ASSERT_EQ(found[i].geometry != kNoGeometry, isHit);
            ASSERT_EQ(blocked[i], isHit);
            occluded += isHit ? 0 : 1;
            if (!isHit) continue;
            ++hits;
            ASSERT_EQ(found[i].geometry, alone.geometry);
            ASSERT_NEAR(found[i].t, alone.t, 1e-4f);
            ASSERT_NEAR(glm::distance(scene.position(found[i]), scene.position(alone)), 0, 1e-4f);
            if (found[i].face != alone.face) continue;
            ASSERT_EQ(found[i].normal, alone.normal);
        }
    }
    EXPECT_GT(hits, 500);
    EXPECT_GT(occluded, 500);
}

}  // namespace
}  // namespace sss
