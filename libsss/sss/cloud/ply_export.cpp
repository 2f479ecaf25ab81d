#include "sss/cloud/ply_export.h"

#include "sss/base/assert.h"
#include "sss/base/atomic_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

namespace sss {
namespace {

static_assert(std::endian::native == std::endian::little, "records are written as they stand");

constexpr std::array kProperties{
    "x", "y", "z", "nx", "ny", "nz", "area", "irradiance_r", "irradiance_g", "irradiance_b"};
using Record = std::array<float, kProperties.size()>;

std::string header(std::size_t count) {
    std::string text = fmt::format(
        "ply\nformat binary_little_endian 1.0\n"
        "comment lengths in mm, area in mm^2, irradiance in W m^-2\nelement vertex {}\n",
        count);
    for (const char* property : kProperties) text += fmt::format("property float {}\n", property);
    return text + "end_header\n";
}

}  // namespace

void exportPly(const std::filesystem::path& path, const PlyPoints& points) {
    const std::size_t count = points.positions.size();
    SSS_ASSERT_EQ(points.normals.size(), count);
    SSS_ASSERT_EQ(points.areas.size(), count);
    SSS_ASSERT_EQ(points.irradiances.size(), count);
    AtomicFile file(path);
    file.append(header(count));
    constexpr std::size_t kBlock = 4096;
    std::vector<Record> block;
    for (std::size_t begin = 0; begin < count; begin += kBlock) {
        block.clear();
        for (std::size_t i = begin; i < std::min(count, begin + kBlock); ++i) {
            const Vec3 &p = points.positions[i], &n = points.normals[i], &e = points.irradiances[i];
            block.push_back({p.x, p.y, p.z, n.x, n.y, n.z, points.areas[i], e.x, e.y, e.z});
        }
        file.append(std::as_bytes(std::span(block)));
    }
    file.commit();
}

}  // namespace sss
