#include "sss/geom/normals.h"

#include "sss/geom/mesh_report.h"
#include "sss/geom/shapes.h"

#include <gtest/gtest.h>

#include <array>

namespace sss {
namespace {

/// The same surface with one vertex a position.
TriangleMesh cube() {
    TriangleMesh mesh;
    for (unsigned i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1u ? 1 : -1, i & 2u ? 1 : -1, i & 4u ? 1 : -1);
    for (const auto& q : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                          {4, 5, 7, 6},
                          {0, 1, 5, 4},
                          {2, 6, 7, 3},
                          {0, 4, 6, 2},
                          {1, 3, 7, 5}}) {
        mesh.faces.emplace_back(q[0], q[1], q[2]);
        mesh.faces.emplace_back(q[0], q[2], q[3]);
    }
    return mesh;
}

TEST(AngleWeightedNormals, DoNotDependOnHowTheCubeIsCut) {
    const TriangleMesh mesh = cube();
    const std::vector<Vec3> normals = angleWeightedNormals(mesh);
    for (std::size_t v = 0; v < 8; ++v)
        EXPECT_LT(glm::distance(DVec3(normals[v]), mesh.positions[v] / std::sqrt(3.0)), 1e-7);
}

TEST(AngleWeightedNormals, HoldAtExtremeScalesAndAreZeroWithoutArea) {
    for (const double scale : {1e-120, 1e120}) {
        TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}};
        for (DVec3& p : mesh.positions) p *= scale;
        EXPECT_EQ(angleWeightedNormals(mesh)[0], (Vec3{0, 0, 1}));
    }
    TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}}, {}, {{0, 1, 2}}};
    for (const Vec3& n : angleWeightedNormals(flat)) EXPECT_TRUE(isZero(n));
}

TEST(WithCreases, SplitsACubeAndKeepsItWatertight) {
    const TriangleMesh sharp = withCreases(cube(), 40);
    EXPECT_EQ(sharp.positions.size(), 24u);
    EXPECT_TRUE(inspectMesh(sharp).closed);
    for (FaceIndex face = 0; face < sharp.faces.size(); ++face) {
        const DVec3 normal = unitOrZero(sharp.faceCross(face));
        for (int c = 0; c < 3; ++c)
            EXPECT_LT(glm::distance(DVec3(sharp.normals[sharp.faces[face][c]]), normal), 1e-7);
    }
    const TriangleMesh smooth = withCreases(cube(), 90);
    EXPECT_EQ(smooth.positions.size(), 8u);
    EXPECT_LT(glm::distance(DVec3(smooth.normals[0]), glm::normalize(smooth.positions[0])), 1e-7);
}

TEST(WithCreases, RestoresTheNormalsOfASphereAndACylinder) {
    TriangleMesh sphere = makeSphere(2);
    sphere.normals.clear();
    const TriangleMesh smooth = withCreases(sphere, 40);
    ASSERT_EQ(smooth.positions.size(), sphere.positions.size());
    for (std::size_t v = 0; v < smooth.positions.size(); ++v)
        ASSERT_LT(glm::distance(DVec3(smooth.normals[v]), smooth.positions[v] / 2.0), 2e-4);

    const TriangleMesh cylinder = makeCylinder(1, 2);
    const TriangleMesh creased = withCreases(cylinder, 40);
    ASSERT_EQ(creased.faces.size(), cylinder.faces.size());
    for (FaceIndex face = 0; face < creased.faces.size(); ++face)
        for (int c = 0; c < 3; ++c)
            ASSERT_LT(glm::distance(creased.normals[creased.faces[face][c]],
                                    cylinder.normals[cylinder.faces[face][c]]),
                      0.012f);
}

}  // namespace
}  // namespace sss
