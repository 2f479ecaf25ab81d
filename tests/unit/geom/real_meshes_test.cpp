#include "sss/geom/mesh_io.h"
#include "sss/geom/mesh_repair.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace sss {
namespace {

/// Only an extra: these files come from outside of the project.
std::filesystem::path meshPath(const char* name) {
    return std::filesystem::path(SSS_SHARED_DIR) / "meshes" / name;
}

struct Expected {
    const char* name;
    std::size_t faces, openEdges, components;
    bool closed;
};

class RealMesh : public ::testing::TestWithParam<Expected> {};

TEST_P(RealMesh, KeepsEveryFace) {
    const Expected& expected = GetParam();
    if (!std::filesystem::exists(meshPath(expected.name))) GTEST_SKIP() << "no " << expected.name;
    const MeshFile file = readMesh(meshPath(expected.name));
    EXPECT_EQ(file.report.faces, expected.faces);
    EXPECT_EQ(file.report.closed, expected.closed);
    EXPECT_EQ(file.report.openEdges, expected.openEdges);
    EXPECT_EQ(file.report.components, expected.components);
    EXPECT_EQ(file.report.reader.droppedFaces, 0u);
    EXPECT_EQ(file.mesh.faceCount(), file.report.faces);
    TriangleMesh mesh = file.mesh;
    repairWinding(mesh);
    const RemovedParts removed = removeUnusable(mesh);
    EXPECT_EQ(removed.degenerateFaces, file.report.degenerateFaces);
    EXPECT_EQ(inspectMesh(mesh).inconsistentEdges, 0u);
}

INSTANTIATE_TEST_SUITE_P(Shared, RealMesh,
                         ::testing::Values(Expected{"igea.ply", 268686, 0, 1, true},
                                           Expected{"spot.obj", 5856, 0, 1, true},
                                           // 32 triangles and 468 quads
                                           Expected{"suzanne.obj", 968, 42, 4, false},
                                           Expected{"teapot.obj", 6320, 160, 4, false}));

}  // namespace
}  // namespace sss
