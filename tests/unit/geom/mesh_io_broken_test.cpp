#include "mesh_bytes.h"
#include "sss/base/error.h"
#include "sss/base/memory.h"
#include "sss/base/rng.h"
#include "sss/geom/face_collector.h"
#include "sss/geom/mesh_io.h"
#include "support/no_more_files.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <vector>

namespace sss {
namespace {

using testing::tetraBinaryStl;
using testing::tetraPly;

/// The error that reading these bytes under this name ends with.
struct Failure {
    ErrorKind kind = ErrorKind::Internal;
    std::string message = "accepted";
    std::string where;
};
Failure failureOf(const char* name, const std::string& bytes) {
    const testing::TemporaryFolder folder;
    testing::writeFile(folder / name, bytes);
    try {
        readMesh(folder / name);
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), (folder / name).string());
        return {error.kind(), error.what(), error.where()};
    }
    return {};
}

void expectBad(const char* name, const std::string& bytes, const std::string& words) {
    const Failure failure = failureOf(name, bytes);
    EXPECT_EQ(failure.kind, ErrorKind::BadInput) << failure.message;
    EXPECT_NE(failure.message.find(words), std::string::npos) << failure.message;
}

TEST(BrokenMesh, MissingFilesAndFoldersAreIoErrors) {
    const testing::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "folder.obj");
    for (const char* name : {"none.obj", "folder.obj"}) {
        try {
            readMesh(folder / name);
            ADD_FAILURE() << "accepted " << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Io);
        }
    }
}

// Where the system has no such files, the sentence stays untried.
TEST(BrokenMesh, FilesThatTheSystemWillNotGive) {
    const testing::TemporaryFolder folder;
    const auto wordsOf = [&](const std::filesystem::path& path) -> std::string {
        try {
            readMesh(path);
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    testing::writeFile(folder / "a.obj", "v 0 0 0\n");
#ifndef SSS_SANITIZED  // the sanitizer asks whether memory is readable by opening a pipe
    {
        const testing::NoMoreFiles limit;
        EXPECT_NE(wordsOf(folder / "a.obj").find("the mesh file cannot be opened; check its perm"),
                  std::string::npos);
    }
#endif
    // States a page, and holds a line.
    std::filesystem::create_symlink("/sys/devices/system/cpu/online", folder / "short.obj");
    EXPECT_NE(wordsOf(folder / "short.obj").find("the mesh file cannot be read to its end"),
              std::string::npos);
    // Takes no room on the disk.
    testing::writeFile(folder / "huge.obj", "");
    std::error_code error;
    std::filesystem::resize_file(folder / "huge.obj", std::uintmax_t{100} << 30, error);
    ASSERT_FALSE(error) << error.message();
    EXPECT_NE(wordsOf(folder / "huge.obj").find("has 107 GB; at most 68.7 can be used"),
              std::string::npos);
    const std::uintmax_t most = std::uintmax_t{64} << 30;
    if (2 * most <= memoryLimitBytes()) return;
    std::filesystem::resize_file(folder / "huge.obj", most);
    EXPECT_NE(wordsOf(folder / "huge.obj").find("a mesh file of 68.7 GB would need 137 GB"),
              std::string::npos)
        << wordsOf(folder / "huge.obj");
}

TEST(BrokenMesh, CollectedFacesAreChecked) {
    FaceCollector collector;
    for (int i = 0; i < 4; ++i) collector.addVertex(Vec3(static_cast<float>(i)));
    const std::uint32_t corners[]{0, 1, 2, 3};
    collector.addFace(corners);
    ReaderReport report;
    const auto wordsOf = [&](std::size_t mostFaces) -> std::string {
        try {
            collector.build(nullptr, report, "a.ply", mostFaces);
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(wordsOf(4), "accepted");
    EXPECT_EQ(wordsOf(1), "a.ply: 2 triangles; at most 1 can be used; simplify the mesh");
    const std::uint32_t beyond[]{0, 1, 4};
    collector.addFace(beyond);
    EXPECT_EQ(wordsOf(4), "a.ply: a face uses vertex 4 of 4; export the mesh again");
}

TEST(BrokenMesh, OtherExtensionsNameTheFour) {
    expectBad("a.fbx", "", ".obj, .ply, .stl or .off");
    expectBad("a", "", ".obj, .ply, .stl or .off");
}

TEST(BrokenMesh, EmptyFilesAndMeshesWithoutFaces) {
    expectBad("a.obj", "", "no faces");
    expectBad("a.off", "", "ends too early");
    expectBad("a.ply", "", "no PLY file");
    expectBad("a.stl", "", "less than the header");
    expectBad("a.obj", "v 0 0 0\nv 1 0 0\np 1\n", "no faces");
    expectBad("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2\nf 1 1 1\n", "none of its 2 faces");
    expectBad("a.off", "OFF\n1 0 0\n0 0 0\n", "no faces");
    expectBad("a.stl", "solid empty\nendsolid\n", "no faces");
    expectBad("a.ply", "ply\nformat ascii 1.0\nend_header\n", "no faces");
}

TEST(BrokenMesh, NamesTheFirstBadVertexAndCountsThem) {
    const std::string face = "f 1 2 3\n";
    expectBad("a.obj", "v 0 0 0\nv 0 nan 0\nv inf 0 1e999\n" + face,
              "vertex 1 (from 0) is at (0, nan, 0)");
    expectBad("a.obj", "v 0 0 0\nv 0 nan 0\nv inf 0 1e999\n" + face, "2 of 3 vertices");
    expectBad("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 -inf 0\n3 0 1 2\n",
              "vertex 2 (from 0) is at (0, -inf, 0)");
    expectBad("a.ply", tetraPly(false, {0, NAN, 0}), "4 of 4 vertices");
    std::string stl = tetraBinaryStl();
    const float bad = INFINITY;
    std::memcpy(stl.data() + 84 + 50 + 12, &bad, 4);
    expectBad("a.stl", stl, "vertex 3 (from 0) is at (inf");
    expectBad("a.stl",
              "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 nan\n"
              "vertex 0 1 0\nendloop\nendfacet\nendsolid\n",
              "vertex 1 (from 0)");
}

TEST(BrokenMesh, IndicesOutOfRange) {
    const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expectBad("a.obj", points + "f 1 2 3\nf 1 2 4\n",
              "line 5: a face uses vertex 4, but the file has 3");
    expectBad("a.obj", points + "f -4 -2 -1\n", "index -4");
    expectBad("a.obj", points + "f 0 1 2\n", "\"0\" is no corner");
    expectBad("a.obj", points + "f 1 2 99999999999999999999\n", "is no corner");
    expectBad("a.obj", points + "vn 0 0 1\nf 1//1 2//1 3//2\n", "uses normal 2");
    expectBad("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "face 0 uses vertex 3");
    expectBad("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "face 0 uses vertex -1");
    std::string ply = tetraPly();
    ply[ply.size() - 4] = 4;
    expectBad("a.ply", ply, "face 3 uses vertex 4, but the file has 4");
    ply[ply.size() - 1] = static_cast<char>(0xff);
    expectBad("a.ply", ply, "is no vertex");
}

TEST(BrokenMesh, TextThatIsNoNumberIsNeverSkipped) {
    expectBad("a.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", "line 2: vertex 2 has \"\"");
    expectBad("a.obj", "v 0 0 0\nv 1,5 0 0\nv 0 1 0\nf 1 2 3\n", "\"1,5\"");
    expectBad("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n", "\"x\" is no corner");
    expectBad("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1/1 2 3\n", "is no corner");
    expectBad("a.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line 4: vertex 1 has \"\"");
    expectBad("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\nx 0 1 2\n", "face 0 starts with \"x\"");
    expectBad("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "face 0 has \"\" as a corner");
    expectBad("a.off", "HELLO\n", "no OFF file");
    expectBad("a.off", "OFF BINARY\n", "binary OFF");
    expectBad("a.off", "OFF\n-1 2 0\n", "\"-1\" is no number of vertices");
    expectBad("a.off", "NOFF\n1 1 0\n0 0 0 1 0\n1 0\n", "lacks a normal");
    expectBad("a.stl", "solid\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n", "is missing");
    expectBad("a.stl", "solid\nouter loop\nvertex 0 0 0\nvertex 1 0 x\n", "\"x\"");
    expectBad("a.stl", "solid\nvertex 0 0 0\n", "outside of");
    expectBad("a.obj", "vn 1\nv 0 0 0\n", "line 1: normal 1 has \"\"");
}

TEST(BrokenMesh, PlyHeaders) {
    const auto header = [](const std::string& middle) {
        return "ply\nformat ascii 1.0\n" + middle + "end_header\n";
    };
    expectBad("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n", "no \"end_header\"");
    expectBad("a.ply", "ply\nformat base64 1.0\nend_header\n", "unknown PLY format");
    expectBad("a.ply", "ply\nend_header\n", "names no format");
    expectBad("a.ply", header("property float x\n"), "before any element");
    expectBad("a.ply", header("element vertex x\n"), "\"x\" is no count");
    expectBad("a.ply", header("element vertex 1\nproperty quad x\n"), "unknown PLY type \"quad\"");
    expectBad("a.ply", header("element vertex 1\nproperty float x\n") + "1 ", "no property \"y\"");
    expectBad("a.ply", header("element face 5\n"), "has no properties");
    expectBad("a.ply", header("nonsense\n"), "unknown word \"nonsense\"");
    expectBad("a.ply",
              header("element tristrips 1\nproperty list int int vertex_indices\n") + "1 0\n",
              "triangle strips");
    expectBad("a.ply",
              header("element face 1\nproperty list uchar int vertex_indices\n") + "-1 0\n",
              "-1 is no length");
    expectBad("a.ply",
              header("element face 1\nproperty list uchar int vertex_indices\n") + "3 0 1.5 0\n",
              "1.5 is no vertex");
    expectBad("a.ply",
              header("element face 1\nproperty list uchar int vertex_indices\n") + "a 0 1 0\n",
              "\"a\" is no number");
}

TEST(BrokenMesh, AbsurdCountsAreRefusedBeforeAllocation) {
    const auto ply = [](const char* format, const char* count) {
        return std::string("ply\nformat ") + format + " 1.0\nelement vertex " + count +
               "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
               "property list uint uint vertex_indices\nend_header\n0 0 0\n";
    };
    for (const char* count : {"4294967295", "9223372036854775807", "1000000"}) {
        expectBad("a.ply", ply("ascii", count), "do not fit");
        expectBad("a.ply", ply("binary_little_endian", count), "do not fit");
    }
    expectBad("a.ply", ply("ascii", "18446744073709551616"), "is no count");
    expectBad("a.ply", ply("ascii", "1") + "4000000000 1 2 3\n", "a list of 4000000000");
    expectBad("a.off", "OFF\n4000000000 1 0\n0 0 0\n", "do not fit");
    expectBad("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n", "number of corners");
    std::string stl(84, '\0');
    stl[83] = 0x7f;
    expectBad("a.stl", stl, "truncated: the header announces");
}

TEST(BrokenMesh, EveryTruncationOfABinaryFileIsNoticed) {
    const std::string ply = tetraPly(), stl = tetraBinaryStl();
    for (std::size_t size = 0; size < ply.size(); size += 7)
        EXPECT_EQ(failureOf("a.ply", ply.substr(0, size)).kind, ErrorKind::BadInput) << size;
    EXPECT_EQ(failureOf("a.ply", ply.substr(0, ply.size() - 1)).kind, ErrorKind::BadInput);
    std::string plain = stl;
    plain[0] = 'x';  // without the word "solid" it can only be binary
    for (std::size_t size = 84; size < stl.size(); size += 7)
        EXPECT_EQ(failureOf("a.stl", plain.substr(0, size)).kind, ErrorKind::BadInput) << size;
}

TEST(BrokenMesh, RandomDamageEndsInAMeshOrAnError) {
    const testing::TemporaryFolder folder;
    const std::vector<std::pair<const char*, std::string>> seeds{
        {"a.ply", tetraPly()},
        {"a.stl", tetraBinaryStl()},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 2 3 4\n"},
        {"a.off", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 255 0 0\n"}};
    Rng rng(21);
    int meshes = 0, errors = 0;
    for (int round = 0; round < 1500; ++round) {
        auto [name, bytes] = seeds[static_cast<std::size_t>(round) % seeds.size()];
        const std::uint64_t edits = 1 + rng.next64() % 4;
        for (std::uint64_t e = 0; e < edits; ++e) {
            const std::size_t at = rng.next64() % bytes.size();
            if (rng.uniform() < 0.7f)
                bytes[at] = static_cast<char>(rng.next32());
            else
                bytes.erase(at, 1 + rng.next64() % 5);
        }
        testing::writeFile(folder / name, bytes);
        try {
            const MeshFile file = readMesh(folder / name);
            for (const UVec3& f : file.mesh.faces)
                for (int c = 0; c < 3; ++c) ASSERT_LT(f[c], file.mesh.positions.size());
            ++meshes;
        } catch (const Error&) {
            ++errors;
        }
    }
    EXPECT_GT(meshes, 100);
    EXPECT_GT(errors, 100);
}

}  // namespace
}  // namespace sss
