#include "sss/geom/mesh_repair.h"

#include "geom_tools.h"
#include "sss/base/parallel.h"
#include "sss/geom/mesh_report.h"
#include "sss/geom/normals.h"
#include "sss/geom/shapes.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::flipFace;
using testing::joined;
using testing::moved;
using testing::volumeOf;

TriangleMesh inverted(TriangleMesh mesh) {
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) flipFace(mesh, face);
    for (Vec3& n : mesh.normals) n = -n;
    return mesh;
}

TEST(RepairWinding, TurnsAnInvertedBoxWithItsNormals) {
    const TriangleMesh box = makeBox({1, 2, 3}, 0.5);
    TriangleMesh mesh = inverted(box);
    EXPECT_EQ(inspectMesh(mesh).flippedComponents, 1u);
    const WindingRepair repair = repairWinding(mesh);
    EXPECT_EQ(repair.flippedFaces, box.faceCount());
    EXPECT_EQ(repair.flippedComponents, 1u);
    EXPECT_NEAR(volumeOf(mesh), 6, 1e-12);
    EXPECT_EQ(mesh.normals, box.normals);
    EXPECT_EQ(repairWinding(mesh).flippedFaces, 0u);
}

TEST(RepairWinding, MendsASphereWhoseFacesAreHalfFlipped) {
    const TriangleMesh sphere = makeSphere(3);
    for (const float share : {0.3f, 0.5f, 0.8f}) {
        TriangleMesh mesh = sphere;
        Rng rng(5);
        std::size_t flipped = 0;
        for (std::size_t face = 0; face < mesh.faces.size(); ++face)
            if (rng.uniform() < share) flipFace(mesh, face), ++flipped;
        EXPECT_GT(inspectMesh(mesh).inconsistentEdges, 1000u);
        EXPECT_EQ(repairWinding(mesh).flippedFaces, flipped);
        EXPECT_NEAR(volumeOf(mesh), volumeOf(sphere), 1e-10);
        EXPECT_EQ(inspectMesh(mesh).inconsistentEdges, 0u);
        EXPECT_EQ(mesh.normals, sphere.normals);
    }
}

TEST(RepairWinding, TurnsTheInnerWallOfAHollowBodyInward) {
    const TriangleMesh outer = makeBox({4, 4, 4}), wall = makeSphere(1.5),
                       core = makeBox({1, 1, 1});
    const double hollow = 64 - volumeOf(wall) + 1;
    for (const bool flipOuter : {false, true})
        for (const bool flipWall : {false, true}) {
            TriangleMesh mesh = joined(joined(core, flipWall ? inverted(wall) : wall),
                                       flipOuter ? inverted(outer) : outer);
            repairWinding(mesh);
            EXPECT_NEAR(volumeOf(mesh), hollow, 1e-10);
        }
}

TEST(RepairWinding, LeavesNeighboursInsideEachOthersBoxesOutward) {
    // A small sphere in the corner of a large one's bounding box, but outside of it.
    TriangleMesh mesh = joined(makeSphere(1), inverted(moved(makeSphere(0.1), DVec3{0.85})));
    repairWinding(mesh);
    const double expected = volumeOf(makeSphere(1)) * 1.001;
    EXPECT_NEAR(volumeOf(mesh), expected, 1e-10);
}

TEST(RepairWinding, WorksFarFromTheOrigin) {
    const DVec3 far{1e6, -2e6, 3e6};
    TriangleMesh mesh = moved(inverted(makeBox({1e-3, 1e-3, 1e-3})), far);
    EXPECT_EQ(repairWinding(mesh).flippedComponents, 1u);
    EXPECT_NEAR(volumeOf(moved(mesh, -far)) / 1e-9, 1, 1e-5);
}

TEST(RepairWinding, OpenBowlTurnsOutwardAndFlatSheetKeepsItsMajority) {
    TriangleMesh bowl = makeSphere(1);
    std::erase_if(bowl.faces, [&](const UVec3& f) { return bowl.positions[f.x].y > 0.3; });
    const TriangleMesh right = bowl;
    bowl = inverted(bowl);
    repairWinding(bowl);
    EXPECT_EQ(bowl.faces, right.faces);

    TriangleMesh sheet = makeRectangle(2, 2, 0.2);
    for (std::size_t face = 0; face < sheet.faces.size(); face += 3) flipFace(sheet, face);
    repairWinding(sheet);
    EXPECT_EQ(sheet.faces, makeRectangle(2, 2, 0.2).faces);
    TriangleMesh down = inverted(sheet);
    EXPECT_EQ(repairWinding(down).flippedFaces, 0u);
}

TEST(RepairWinding, LeavesAMoebiusStripAlone) {
    TriangleMesh strip;
    constexpr std::uint32_t kSteps = 40;
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const double a = 2 * kPi * i / kSteps;
        for (const double side : {-0.3, 0.3}) {
            const double r = 1 + side * std::cos(a / 2);
            strip.positions.emplace_back(r * std::cos(a), r * std::sin(a), side * std::sin(a / 2));
        }
    }
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const std::uint32_t a = 2 * i, b = 2 * i + 1;
        const bool last = i + 1 == kSteps;
        const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        strip.faces.emplace_back(a, b, d);
        strip.faces.emplace_back(a, d, c);
    }
    const std::vector<UVec3> before = strip.faces;
    EXPECT_EQ(inspectMesh(strip).nonOrientable, 1u);
    EXPECT_EQ(repairWinding(strip).flippedFaces, 0u);
    EXPECT_EQ(strip.faces, before);
}

TEST(RepairWinding, IsTheSameForAnyNumberOfThreads) {
    TriangleMesh many;
    Rng rng(8);
    for (int i = 0; i < 60; ++i) {
        const double size = 0.1 + 3 * rng.uniformDouble();
        const DVec3 at{rng.uniformDouble(), rng.uniformDouble(), rng.uniformDouble()};
        many = joined(many, moved(makeBox(DVec3{size}), at * 0.1));
    }
    TriangleMesh one = many, two = many;
    {
        const ThreadLimit limit(1);
        repairWinding(one);
    }
    const ThreadLimit limit(2);
    repairWinding(two);
    EXPECT_EQ(one.faces, two.faces);
}

TEST(RemoveUnusable, TakesOutExactlyTheUseless) {
    TriangleMesh mesh = makeBox({1, 1, 1});
    const std::vector<UVec3> faces = mesh.faces;
    const std::vector<Vec3> normals = mesh.normals;
    const std::vector<DVec3> positions = mesh.positions;
    // In front: a stray vertex, and a face that repeats a corner.
    mesh = TriangleMesh{{DVec3{100}}, {Vec3{1, 0, 0}}, {}};
    const UVec3 f = faces[3] + UVec3{1};
    mesh.faces.emplace_back(f.y, f.y, f.z);
    mesh = testing::joined(mesh, makeBox({1, 1, 1}));
    // Behind: two duplicates, one of them turned, and a face of three points in a row.
    mesh.faces.emplace_back(f.z, f.x, f.y);
    mesh.faces.emplace_back(f.x, f.z, f.y);
    const TriangleMesh line{{DVec3{5}, DVec3{6}, DVec3{7}}, {3, Vec3{0, 0, 1}}, {{0, 1, 2}}};
    mesh = testing::joined(mesh, line);

    const MeshReport report = inspectMesh(mesh);
    EXPECT_EQ(report.degenerateFaces, 2u);
    EXPECT_EQ(report.duplicateFaces, 2u);
    EXPECT_EQ(report.unreferencedVertices, 1u);
    const RemovedParts removed = removeUnusable(mesh);
    EXPECT_EQ(removed.degenerateFaces, 2u);
    EXPECT_EQ(removed.duplicateFaces, 2u);
    EXPECT_EQ(removed.unreferencedVertices, 4u);
    EXPECT_EQ(mesh.faces, faces);
    EXPECT_EQ(mesh.positions, positions);
    EXPECT_EQ(mesh.normals, normals);
}

TEST(RemoveUnusable, KeepsNeedlesAndTinyTriangles) {
    for (const double scale : {1e-100, 1e-9, 1.0, 1e9, 1e100}) {
        TriangleMesh needle{{{0, 0, 0}, {scale, 0, 0}, {0, 1e-6 * scale, 0}}, {}, {{0, 1, 2}}};
        EXPECT_FALSE(isDegenerate(needle, 0)) << scale;
        needle.positions[2].y = 0;
        EXPECT_TRUE(isDegenerate(needle, 0)) << scale;
    }
}

}  // namespace
}  // namespace sss
