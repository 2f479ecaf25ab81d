#include "sss/cloud/ply_export.h"

#include "sss/base/error.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <sstream>
#include <vector>

namespace sss {
namespace {

using testing::readFile;
using testing::TemporaryFolder;

TEST(PlyExport, RecordsFollowTheHeader) {
    const TemporaryFolder folder;
    constexpr std::size_t kCount = 5000;  // more than one block
    std::vector<Vec3> positions, normals;
    std::vector<Rgb> irradiances;
    std::vector<float> areas;
    for (std::size_t i = 0; i < kCount; ++i) {
        const float f = static_cast<float>(i);
        positions.push_back({f, f + 0.25f, -f});
        normals.push_back({0, 0, 1});
        areas.push_back(f * 0.5f);
        irradiances.push_back({f + 1, f + 2, f + 3});
    }
    exportPly(folder / "points.ply", {positions, normals, areas, irradiances});

    const std::string bytes = readFile(folder / "points.ply");
    const std::string endMark = "end_header\n";
    const std::size_t dataBegin = bytes.find(endMark) + endMark.size();
    std::istringstream header(bytes.substr(0, dataBegin));
    std::vector<std::string> lines;
    for (std::string line; std::getline(header, line);)
        if (line.rfind("comment", 0) != 0) lines.push_back(line);
    const std::vector<std::string> expected{"ply",
                                            "format binary_little_endian 1.0",
                                            "element vertex 5000",
                                            "property float x",
                                            "property float y",
                                            "property float z",
                                            "property float nx",
                                            "property float ny",
                                            "property float nz",
                                            "property float area",
                                            "property float irradiance_r",
                                            "property float irradiance_g",
                                            "property float irradiance_b",
                                            "end_header"};
    EXPECT_EQ(lines, expected);
    ASSERT_EQ(bytes.size() - dataBegin, kCount * 10 * sizeof(float));
    for (const std::size_t i : {std::size_t{0}, std::size_t{4095}, std::size_t{4096}, kCount - 1}) {
        std::array<float, 10> record;
        std::memcpy(record.data(), bytes.data() + dataBegin + i * sizeof record, sizeof record);
        const float f = static_cast<float>(i);
        const std::array<float, 10> wanted{f, f + 0.25f, -f,    0,     0,
                                           1, f * 0.5f,  f + 1, f + 2, f + 3};
        EXPECT_EQ(record, wanted) << i;
    }
}

TEST(PlyExport, NoPointsIsAValidFile) {
    const TemporaryFolder folder;
    exportPly(folder / "none.ply", {});
    EXPECT_NE(readFile(folder / "none.ply").find("element vertex 0\n"), std::string::npos);
}

TEST(PlyExport, UnwritableTargetIsAnIoError) {
    try {
        exportPly("/no-such-folder/points.ply", {});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Io);
        EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos);
    }
}

}  // namespace
}  // namespace sss
