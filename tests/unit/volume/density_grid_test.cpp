#include "sss/volume/density_grid.h"

#include "sss/base/error.h"
#include "sss/base/memory.h"
#include "unit/volume/volume_tools.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace sss {
namespace {

using namespace testing;

std::string complaintAbout(const GridFile& file) {
    try {
        DensityGrid::read(file);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

// Trilinear values along a line within a cell are the cubic that along() says.
TEST(DensityGrid, IsACubicAlongALine) {
    const auto value = [](double x, double y, double z) {
        return 1 + x + 2 * y + 3 * z + 7 * x * y * z;
    };
    std::vector<float> nodes;
    for (int k = 0; k < 8; ++k)
        nodes.push_back(static_cast<float>(value(k & 1, k >> 1 & 1, k >> 2 & 1)));
    const DensityGrid grid({2, 2, 2}, 1, nodes);
    const DVec3 from(0.1, 0.9, 0.2), to(0.8, 0.3, 0.95);
    const DensityCubic cubic = grid.along({0, 0, 0}, Vec3(from), Vec3(to));
    // In float: terms of up to 60 cancel to 7.
    double integral = 0;
    for (int i = 0; i < 1000; ++i) {
        const double s = (i + 0.5) / 1000;
        const DVec3 p = from + (to - from) * s;
        EXPECT_NEAR(cubic.densityAt(static_cast<float>(s)), value(p.x, p.y, p.z), 2e-5);
        integral += value(p.x, p.y, p.z) / 1000;
    }
    EXPECT_NEAR(cubic.integralTo(1), integral, 1e-5);
    EXPECT_FALSE(cubic.isConstant());
}

TEST(DensityGrid, ReadsWhatStandsInTheFile) {
    const TemporaryFolder folder;
    const GridFile file = writeGrid(
        folder.path() / "a.raw", {3, 2, 4}, 4,
        [](const DVec3& p, int c) { return p.x < 0.6 ? 0.0f : static_cast<float>(p.z + c); });
    const DensityGrid grid = DensityGrid::read(file);
    EXPECT_EQ(grid.cells(), (DensityGrid::Cell{2, 1, 3}));
    EXPECT_EQ(grid.cellCount(), 6u);
    EXPECT_TRUE(grid.isEmpty({0, 0, 1}));
    EXPECT_FALSE(grid.isEmpty({1, 0, 0}));
    const Vec4 mean = grid.mean({1, 0, 2});  // half of it 0, z from 2/3 to 1
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(mean[c], 0.5 * (5.0 / 6 + c), 1e-6);
    for (std::size_t i = 0; i < grid.cellCount(); ++i) EXPECT_EQ(grid.indexOf(grid.cellOf(i)), i);
}

TEST(DensityGrid, RefusesWhatCannotBe) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "a.raw";
    GridFile file = writeGrid(
        path, {2, 2, 2}, 1, [](const DVec3& p, int) { return p.x > 0 && p.y > 0 ? -1.0f : 0.0f; });
    EXPECT_EQ(complaintAbout(file),
              path.string() + ": value 3 is -1; densities are finite and not negative");
    file.nz = 3;
    EXPECT_EQ(complaintAbout(file),
              path.string() +
                  ": has 32 bytes, and 2 x 2 x 3 nodes of 1 floats take 48; check "
                  "\"dimensions\" and \"channels\" of the grid");
    file.path = folder.path() / "none.raw";
    EXPECT_EQ(complaintAbout(file),
              file.path.string() + ": cannot be opened as a grid of densities");
    // States a page, and holds a line.
    const GridFile system{"/sys/devices/system/cpu/online", 16, 16, 4, 1};
    if (std::filesystem::exists(system.path) && std::filesystem::file_size(system.path) == 4096) {
        EXPECT_EQ(complaintAbout(system), system.path.string() + ": cannot be read to its end");
    }
    // Takes no room on the disk.
    file = {folder.path() / "huge.raw", 4096, 4096, 4096, 4};
    std::ofstream(file.path).flush();
    std::filesystem::resize_file(file.path, std::uintmax_t{1} << 40);
    if (memoryLimitBytes() < std::uint64_t{1} << 40) {
        EXPECT_EQ(complaintAbout(file).find(
                      file.path.string() + ": a grid of 4096 x 4096 x 4096 nodes of 4 floats would "
                                           "need 1.1e+03 GB of memory; there are "),
                  0u)
            << complaintAbout(file);
    }
}

}  // namespace
}  // namespace sss
