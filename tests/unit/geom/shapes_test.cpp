#include "sss/geom/shapes.h"

#include "geom_tools.h"
#include "sss/geom/mesh_report.h"
#include "sss/geom/normals.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sss {
namespace {

using testing::volumeOf;

double longestEdge(const TriangleMesh& mesh) {
    double longest = 0;
    for (const UVec3& f : mesh.faces)
        for (int c = 0; c < 3; ++c)
            longest = std::max(longest,
                               glm::distance(mesh.positions[f[c]], mesh.positions[f[(c + 1) % 3]]));
    return longest;
}

void expectClosedAndOutward(const TriangleMesh& mesh) {
    const MeshReport report = inspectMesh(mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.openEdges, 0u);
    EXPECT_EQ(report.nonManifoldEdges, 0u);
    EXPECT_EQ(report.inconsistentEdges, 0u);
    EXPECT_EQ(report.flippedFaces, 0u);
    EXPECT_EQ(report.degenerateFaces, 0u);
    EXPECT_EQ(report.duplicateFaces, 0u);
    EXPECT_EQ(report.unreferencedVertices, 0u);
    EXPECT_GT(volumeOf(mesh), 0);
    EXPECT_TRUE(describe(report, 1).empty());
}

/// Every vertex normal lies on the side of each of its faces, within `degrees` of it.
void expectNormalsNearFaces(const TriangleMesh& mesh, double degrees) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    const double least = std::cos(degrees * kPi / 180);
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face) {
        const DVec3 normal = unitOrZero(mesh.faceCross(face));
        for (int c = 0; c < 3; ++c)
            ASSERT_GT(glm::dot(normal, DVec3(mesh.normals[mesh.faces[face][c]])), least);
    }
    for (const Vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-6f);
}

TEST(Sphere, IsClosedRoundAndRightToOnePartInTenThousand) {
    const double r = 7.5;
    const TriangleMesh mesh = makeSphere(r);
    expectClosedAndOutward(mesh);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        ASSERT_NEAR(glm::length(mesh.positions[i]), r, 1e-14 * r);
        ASSERT_NEAR(glm::distance(DVec3(mesh.normals[i]), mesh.positions[i] / r), 0, 1e-7);
    }
    // Euler: V - E + F = 2.
    EXPECT_EQ(mesh.positions.size(), mesh.faces.size() / 2 + 2);
    const double area = 4 * kPi * r * r, volume = area * r / 3;
    EXPECT_LT(mesh.area(), area);
    EXPECT_NEAR(mesh.area() / area, 1 - 4.8e-5, 1e-6);
    EXPECT_GT(volumeOf(mesh) / volume, 1 - 1e-4);
    expectNormalsNearFaces(mesh, 0.8);
}

TEST(Sphere, HonoursTheEdgeLengthUpToTheCap) {
    const TriangleMesh fine = makeSphere(1, 0.0125);
    EXPECT_LE(longestEdge(fine), 0.0125);
    EXPECT_GT(fine.faceCount(), makeSphere(1).faceCount());
    const TriangleMesh capped = makeSphere(1, 1e-6);
    EXPECT_LE(capped.faceCount(), kMaxShapeTriangles);
    EXPECT_GT(capped.faceCount(), kMaxShapeTriangles * 9 / 10);
}

TEST(Rectangle, IsExact) {
    const TriangleMesh mesh = makeRectangle(3, 2, 0.25);
    EXPECT_NEAR(mesh.area(), 6, 1e-13);
    EXPECT_LE(longestEdge(mesh), 0.25);
    EXPECT_EQ(mesh.bounds().lo, (DVec3{-1.5, -1, 0}));
    EXPECT_EQ(mesh.bounds().hi, (DVec3{1.5, 1, 0}));
    for (const Vec3& n : mesh.normals) EXPECT_EQ(n, (Vec3{0, 0, 1}));
    expectNormalsNearFaces(mesh, 1e-4);
    EXPECT_EQ(makeRectangle(3, 2).faceCount(), 2u);
    const MeshReport report = inspectMesh(mesh);
    EXPECT_EQ(report.openLoops, 1u);
    EXPECT_NEAR(report.openLength, 10, 1e-12);
}

TEST(Disk, HasAllItsVerticesInsideAndItsRimOnTheCircle) {
    const TriangleMesh mesh = makeDisk(4);
    const MeshReport report = inspectMesh(mesh);
    EXPECT_EQ(report.openLoops, 1u);
    EXPECT_EQ(report.inconsistentEdges, 0u);
    EXPECT_NEAR(report.openLength / (8 * kPi), 1, 1e-4);
    EXPECT_NEAR(mesh.area() / (16 * kPi), 1 - 7.9e-5, 1e-6);
    expectNormalsNearFaces(mesh, 1e-4);
    EXPECT_LE(longestEdge(makeDisk(4, 0.05)), 0.05);
    EXPECT_LE(makeDisk(4, 1e-9).faceCount(), kMaxShapeTriangles);
}

TEST(Box, IsWatertightWithSharpEdges) {
    const DVec3 size{2, 3, 0.1};
    for (const double maxEdge : {kAnyEdge, 0.3, 0.07}) {
        const TriangleMesh mesh = makeBox(size, maxEdge);
        expectClosedAndOutward(mesh);
        // The rounding of a sum over 1e4 faces.
        EXPECT_NEAR(volumeOf(mesh), 0.6, 2e-12);
        EXPECT_NEAR(mesh.area(), 2 * (6 + 0.3 + 0.2), 2e-11);
        EXPECT_LE(longestEdge(mesh), maxEdge);
        expectNormalsNearFaces(mesh, 1e-4);
    }
    EXPECT_EQ(makeBox(size).faceCount(), 12u);
    EXPECT_LE(makeBox({1000, 1000, 1000}, 1e-3).faceCount(), kMaxShapeTriangles * 101 / 100);
}

TEST(Cylinder, IsWatertightWithSharpRims) {
    const double r = 1.5, h = 4;
    const TriangleMesh mesh = makeCylinder(r, h);
    expectClosedAndOutward(mesh);
    EXPECT_NEAR(volumeOf(mesh) / (kPi * r * r * h), 1, 1e-4);
    EXPECT_NEAR(mesh.area() / (2 * kPi * r * (r + h)), 1, 1e-4);
    expectNormalsNearFaces(mesh, 0.7);
    EXPECT_EQ(mesh.bounds().lo.y, -2);
    EXPECT_EQ(mesh.bounds().hi.y, 2);
    EXPECT_LE(longestEdge(makeCylinder(r, h, 0.04)), 0.04);
    expectClosedAndOutward(makeCylinder(r, 1e-3));
    expectClosedAndOutward(makeCylinder(0.01, 5, 0.1));
    EXPECT_LE(makeCylinder(r, h, 1e-9).faceCount(), kMaxShapeTriangles);
}

}  // namespace
}  // namespace sss
