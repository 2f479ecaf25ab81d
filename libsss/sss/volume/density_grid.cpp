#include "sss/volume/density_grid.h"

#include "sss/base/assert.h"
#include "sss/base/error.h"
#include "sss/base/require_memory.h"

#include <fmt/core.h>

#include <bit>
#include <fstream>

namespace sss {
namespace {

static_assert(std::endian::native == std::endian::little, "grid files are read as they stand");

Vec4 mix(const Vec4& a, const Vec4& b, float t) { return a + (b - a) * t; }

Vec4 trilinear(const std::array<Vec4, 8>& v, const Vec3& p) {
    const Vec4 y0 = mix(mix(v[0], v[1], p.x), mix(v[2], v[3], p.x), p.y);
    const Vec4 y1 = mix(mix(v[4], v[5], p.x), mix(v[6], v[7], p.x), p.y);
    return mix(y0, y1, p.z);
}

std::size_t product(const DensityGrid::Cell& counts) {
    std::size_t all = 1;
    for (const int count : counts) all *= static_cast<std::size_t>(count);
    return all;
}

}  // namespace

DensityGrid::DensityGrid(const Cell& nodes, int channels, std::vector<float> values)
    : nodes_(nodes),
      cells_{nodes[0] - 1, nodes[1] - 1, nodes[2] - 1},
      channels_(channels),
      values_(std::move(values)) {
    SSS_ASSERT_EQ(values_.size(), product(nodes_) * static_cast<std::size_t>(channels_));
    isEmpty_.resize(product(cells_));
    for (std::size_t i = 0; i < isEmpty_.size(); ++i)
        isEmpty_[i] = mean(cellOf(i)) == Vec4(0) ? 1 : 0;
}

DensityGrid DensityGrid::read(const GridFile& file) {
    const std::string where = file.path.string();
    std::ifstream in(file.path, std::ios::binary | std::ios::ate);
    if (!in) throw Error(ErrorKind::Io, where, "cannot be opened as a grid of densities");
    const std::size_t count =
        static_cast<std::size_t>(file.nx) * static_cast<std::size_t>(file.ny) *
        static_cast<std::size_t>(file.nz) * static_cast<std::size_t>(file.channels);
    const auto bytes = static_cast<std::size_t>(in.tellg());
    if (bytes != count * sizeof(float))
        throw Error(ErrorKind::BadInput, where,
                    fmt::format("has {} bytes, and {} x {} x {} nodes of {} floats take {}", bytes,
                                file.nx, file.ny, file.nz, file.channels, count * sizeof(float)),
                    "check \"dimensions\" and \"channels\" of the grid");
    requireMemory(where,
                  fmt::format("a grid of {} x {} x {} nodes of {} floats", file.nx, file.ny,
                              file.nz, file.channels),
                  bytes, "use a coarser grid");
    std::vector<float> values(count);
    in.seekg(0);
    if (!in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(bytes)))
        throw Error(ErrorKind::Io, where, "cannot be read to its end");
    for (std::size_t i = 0; i < count; ++i)
        if (!(values[i] >= 0) || !std::isfinite(values[i]))
            throw Error(
                ErrorKind::BadInput, where,
                fmt::format("value {} is {}; densities are finite and not negative", i, values[i]));
    return DensityGrid({file.nx, file.ny, file.nz}, file.channels, std::move(values));
}

DensityGrid::Cell DensityGrid::cellOf(std::size_t index) const {
    const auto nx = static_cast<std::size_t>(cells_[0]), ny = static_cast<std::size_t>(cells_[1]);
    return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
            static_cast<int>(index / (nx * ny))};
}

Vec4 DensityGrid::node(int x, int y, int z) const {
    const std::size_t index = (static_cast<std::size_t>(z) * static_cast<std::size_t>(nodes_[1]) +
                               static_cast<std::size_t>(y)) *
                                  static_cast<std::size_t>(nodes_[0]) +
                              static_cast<std::size_t>(x);
    if (channels_ == 1) return Vec4(values_[index]);
    const float* v = values_.data() + 4 * index;
    return {v[0], v[1], v[2], v[3]};
}

std::array<Vec4, 8> DensityGrid::corners(const Cell& c) const {
    std::array<Vec4, 8> v;
    for (int k = 0; k < 8; ++k)
        v[static_cast<std::size_t>(k)] =
            node(c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2 & 1));
    return v;
}

Vec4 DensityGrid::mean(const Cell& cell) const {
    Vec4 sum(0);
    for (const Vec4& corner : corners(cell)) sum += corner;
    return sum * 0.125f;
}

DensityCubic DensityGrid::along(const Cell& cell, const Vec3& from, const Vec3& to) const {
    const std::array<Vec4, 8> v = corners(cell);
    const Vec3 base(static_cast<float>(cell[0]), static_cast<float>(cell[1]),
                    static_cast<float>(cell[2]));
    const auto valueAt = [&](float s) {
        return trilinear(v, glm::clamp(from + (to - from) * s - base, Vec3(0), Vec3(1)));
    };
    // The cubic through four values, at 0, 1/3, 2/3 and 1.
    const Vec4 a = valueAt(0), b = valueAt(1.0f / 3), c = valueAt(2.0f / 3), d = valueAt(1);
    DensityCubic cubic;
    cubic.c[0] = a;
    cubic.c[1] = (b * 18.0f - a * 11.0f - c * 9.0f + d * 2.0f) * 0.5f;
    cubic.c[2] = (a * 2.0f - b * 5.0f + c * 4.0f - d) * 4.5f;
    cubic.c[3] = (b * 3.0f - a - c * 3.0f + d) * 4.5f;
    return cubic;
}

}  // namespace sss
