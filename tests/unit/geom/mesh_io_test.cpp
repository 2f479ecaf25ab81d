#include "sss/geom/mesh_io.h"

#include "mesh_bytes.h"
#include "sss/geom/shapes.h"
#include "support/temporary_folder.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <thread>

namespace sss {
namespace {

using testing::append;
using testing::tetraBinaryStl;
using testing::tetraPly;

MeshFile readText(const char* name, const std::string& bytes) {
    const testing::TemporaryFolder folder;
    testing::writeFile(folder / name, bytes);
    return readMesh(folder / name);
}

void expectTetra(const MeshFile& file, const DVec3& at = DVec3{0}, double size = 1) {
    ASSERT_EQ(file.mesh.positions.size(), 4u);
    ASSERT_EQ(file.mesh.faceCount(), 4u);
    EXPECT_TRUE(file.report.closed);
    EXPECT_EQ(file.report.flippedFaces, 0u);
    EXPECT_EQ(file.report.reader.fileFaces, 4u);
    for (const DVec3& p : testing::kTetraPoints) {
        const DVec3 expected = at + size * p;
        EXPECT_NE(std::find(file.mesh.positions.begin(), file.mesh.positions.end(), expected),
                  file.mesh.positions.end());
    }
}

TEST(ReadMesh, ReadsATetrahedronInEveryFormat) {
    expectTetra(readText("t.ply", tetraPly()));
    expectTetra(readText("t.PLY", tetraPly(true)));
    const MeshFile stl = readText("t.StL", tetraBinaryStl());
    expectTetra(stl);
    EXPECT_EQ(stl.report.reader.mergedVertices, 8u);
    expectTetra(
        readText("t.obj",
                 "# comment\nmtllib /dev/zero\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0 1 .5 0\n"
                 "vt 0 0\nv 0 0 1\nusemtl x\nf 1 3 2\nf 1/1 2/1 4/1 # 3 3\r\nf 1 \\\n 4 3\n"
                 "f -3 -2 -1\n"));
    expectTetra(
        readText("t.off",
                 "COFF # colours\n\n4 4 6\n0 0 0 255 0 0\n1 0 0 255 0 0\n# here\n0 1 0 1 1 1 1\n"
                 "0 0 1 0 0 0\n3 0 2 1 0.5 0.5 0.5\n3 0 1 3\n3 0 3 2 7\n3 1 2 3\n"));
    expectTetra(readText(
        "t2.off", "OFF 4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3"));
    expectTetra(
        readText("t.ply",
                 "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                 "property list uchar int extra\nproperty float z\nelement edge 1\n"
                 "property int a\nelement face 4\nproperty list uchar float texcoord\n"
                 "property list uchar uint vertex_indices\nproperty int flags\nend_header\n"
                 "0 0 0 0\n1 0 2 5 6 0\n0 1 1 9 0\n0 0 0 1\n3\n2 0.5 0.5 3 0 2 1 0\n"
                 "0 3 0 1 3 0\n0 3 0 3 2 0\n0 3 1 2 3 0\n"));
    std::string ascii = "solid t\n";
    for (const auto& f : testing::kTetraFaces) {
        ascii += " facet normal 0 0 0\r\n  outer loop\r\n";
        for (std::uint32_t v : f) {
            const DVec3& p = testing::kTetraPoints[v];
            ascii += fmt::format("   vertex {} {} {:e}\r\n", p.x, p.y, p.z);
        }
        ascii += "  endloop\r\n endfacet\r\n";
    }
    expectTetra(readText("a.stl", ascii + "endsolid t\r\n"));
}

TEST(ReadMesh, KeepsDetailFarFromTheOrigin) {
    const DVec3 far{1e6, -1e6, 1e6};
    expectTetra(readText("t.ply", tetraPly(false, far, 1e-3)), far, 1e-3);
    std::string obj, off = "OFF\n4 4 0\n";
    for (const DVec3& p : testing::kTetraPoints) {
        const DVec3 q = far + 1e-3 * p;
        obj += fmt::format("v {} {} {}\n", q.x, q.y, q.z);
        off += fmt::format("{} {} {}\n", q.x, q.y, q.z);
    }
    for (const auto& f : testing::kTetraFaces) {
        obj += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
        off += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
    }
    expectTetra(readText("t.obj", obj), far, 1e-3);
    expectTetra(readText("t.off", off), far, 1e-3);
}

TEST(ReadMesh, LosesNoFaceOfANonManifoldFan) {
    const MeshFile fan = readText("fan.obj",
                                  "v 0 0 0\nv 0 0 2\nv 1 0 0\nv 0 1 0\nv -1 -1 0\n"
                                  "f 1 2 3\nf 1 2 4\nf 1 2 5\n");
    EXPECT_EQ(fan.mesh.positions.size(), 5u);
    EXPECT_EQ(fan.mesh.faceCount(), 3u);
    EXPECT_EQ(fan.report.nonManifoldEdges, 1u);
    // A face twice, and once more the other way round.
    const MeshFile twice =
        readText("two.off", "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 1 2 0\n3 0 2 1\n");
    EXPECT_EQ(twice.mesh.faceCount(), 3u);
    EXPECT_EQ(twice.report.duplicateFaces, 2u);
}

TEST(ReadMesh, CountsWhatHasNoSurface) {
    const MeshFile obj = readText("d.obj",
                                  "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 9 9 9\n"
                                  "f 1 2 3\nf 2 2 3\nf 1 2\nf 1 2 3 1\nf 1 2 4 3\n");
    EXPECT_EQ(obj.report.reader.fileFaces, 5u);
    EXPECT_EQ(obj.report.reader.droppedFaces, 2u);
    EXPECT_EQ(obj.report.reader.polygons, 2u);
    EXPECT_EQ(obj.report.degenerateFaces, 1u);  // of the quad 1 2 3 1
    EXPECT_EQ(obj.report.unreferencedVertices, 1u);
    EXPECT_EQ(obj.mesh.faceCount(), 5u);

    const MeshFile off = readText("d.off",
                                  "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n2 0 1\n"
                                  "3 1 1 2\n4 0 1 3 2\n");
    EXPECT_EQ(off.report.reader.droppedFaces, 2u);
    EXPECT_EQ(off.report.degenerateFaces, 0u);
    EXPECT_EQ(off.report.reader.polygons, 1u);
    EXPECT_EQ(off.mesh.faceCount(), 3u);
    EXPECT_EQ(off.mesh.area(), 1.5);

    std::string stl = tetraBinaryStl();
    std::memcpy(stl.data() + 84 + 12 + 24, stl.data() + 84 + 12, 12);  // third corner = first
    const MeshFile soup = readText("d.stl", stl);
    EXPECT_EQ(soup.report.reader.droppedFaces, 1u);
    EXPECT_EQ(soup.mesh.faceCount(), 3u);
}

TEST(ReadMesh, CutsAConcavePolygonInside) {
    const MeshFile file = readText("p.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 0\nf 1 2 3 4\n");
    EXPECT_EQ(file.mesh.faceCount(), 2u);
    EXPECT_NEAR(file.mesh.area(), 6, 1e-14);
}

TEST(ReadMesh, SplitsVerticesThatHaveSeveralNormals) {
    // A roof: its ridge 1-2 has one normal on each side.
    const std::string roof = "v 0 1 0\nv 0 1 1\nv 1 0 0\nv -1 0 0\nvn 2 2 0\nvn -1 1 0\n";
    const MeshFile file = readText("n.obj", roof + "f 1//1 2//1 3//1\nf 2//2 1//2 4//2\n");
    EXPECT_TRUE(file.report.reader.hasFileNormals);
    EXPECT_EQ(file.report.reader.splitVertices, 2u);
    ASSERT_EQ(file.mesh.normals.size(), 6u);
    ASSERT_EQ(file.mesh.positions.size(), 6u);
    EXPECT_EQ(file.report.openEdges, 4u);  // the ridge still joins
    const float h = std::sqrt(0.5f);
    for (FaceIndex face = 0; face < 2; ++face)
        for (int c = 0; c < 3; ++c) {
            const Vec3 n = file.mesh.normals[file.mesh.faces[face][c]];
            EXPECT_LT(glm::distance(n, Vec3(face == 0 ? h : -h, h, 0)), 1e-6f);
        }
    // Normals for a part only, or unusable ones, are ignored, and it says so.
    for (const char* faces :
         {"f 1//1 2//1 3//1\nf 2 1 4\n", "vn nan nan nan\nf 1//1 2//1 3//1\nf 2//3 1//3 4//3\n",
          "vn 0 0 0\nf 1//3 2//1 3//1\nf 2//2 1//2 4//2\n"}) {
        const MeshFile part = readText("n.obj", roof + faces);
        EXPECT_TRUE(part.mesh.normals.empty());
        EXPECT_TRUE(part.report.reader.ignoredNormals);
        EXPECT_EQ(part.mesh.positions.size(), 4u);
    }
}

TEST(ReadMesh, KeepsNormalsByVertex) {
    const MeshFile off =
        readText("n.off", "NOFF\n3 1 0\n0 0 0 0 0 2\n1 0 0 0 3 0\n0 1 0 4 0 0\n3 0 1 2\n");
    ASSERT_EQ(off.mesh.normals.size(), 3u);
    EXPECT_EQ(off.mesh.normals[0], (Vec3{0, 0, 1}));
    EXPECT_EQ(off.mesh.normals[1], (Vec3{0, 1, 0}));
    EXPECT_EQ(off.mesh.normals[2], (Vec3{1, 0, 0}));
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float nx\nproperty float ny\n"
        "property float nz\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 1\nproperty list uchar uint vertex_indices\nend_header\n";
    // The normal of a vertex that no face uses does not matter.
    const MeshFile ply = readText("n.ply", header +
                                               "0 0 2 0 0 0\n0 3 0 1 0 0\n4 0 0 0 1 0\n"
                                               "nan nan nan 5 5 5\n3 0 1 2\n");
    ASSERT_EQ(ply.mesh.normals.size(), 4u);
    EXPECT_EQ(ply.mesh.normals[1], (Vec3{0, 1, 0}));
    EXPECT_TRUE(ply.report.reader.hasFileNormals);
    const MeshFile bad = readText("n.ply", header +
                                               "0 0 2 0 0 0\nnan 3 0 1 0 0\n4 0 0 0 1 0\n"
                                               "0 0 1 5 5 5\n3 0 1 2\n");
    EXPECT_TRUE(bad.mesh.normals.empty());
    EXPECT_TRUE(bad.report.reader.ignoredNormals);
}

TEST(ReadMesh, RoundTripsAShapeAndSeesItClosed) {
    const TriangleMesh box = makeBox({1.1, 2.3, 0.7}, 0.2);
    std::string obj;
    for (std::size_t v = 0; v < box.positions.size(); ++v) {
        const DVec3& p = box.positions[v];
        const Vec3& n = box.normals[v];
        obj += fmt::format("v {} {} {}\nvn {} {} {}\n", p.x, p.y, p.z, n.x, n.y, n.z);
    }
    for (const UVec3& f : box.faces)
        obj += fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", f.x + 1, f.y + 1, f.z + 1);
    const MeshFile file = readText("box.obj", obj);
    EXPECT_EQ(file.mesh.positions, box.positions);
    EXPECT_EQ(file.mesh.normals, box.normals);
    EXPECT_EQ(file.mesh.faces, box.faces);
    EXPECT_TRUE(file.report.closed);
    EXPECT_TRUE(describe(file.report, 1).empty());
}

TEST(ReadMesh, PrintsNothingAndMayRunInThreads) {
    const testing::TemporaryFolder folder;
    testing::writeFile(folder / "a.ply", tetraPly());
    testing::writeFile(folder / "b.obj",
                       "mtllib none.mtl\nusemtl gone\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            for (int round = 0; round < 20; ++round) {
                EXPECT_EQ(readMesh(folder / "a.ply").mesh.faceCount(), 4u);
                EXPECT_EQ(readMesh(folder / "b.obj").mesh.faceCount(), 1u);
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace sss
