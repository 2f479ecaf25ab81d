#pragma once
#include "sss/base/vec.h"
#include "sss/cloud/solved_exitance.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sss {

/// Number of grid point (i, j), i + j <= n, of a triangle cut into n segments an edge, row by row.
inline std::uint32_t gridIndex(std::uint32_t i, std::uint32_t j, std::uint32_t n) {
    return j * (n + 1) - j * (j - 1) / 2 + i;
}

/// How to interpolate at a place of a triangle with a regular grid of values: which of them, and
/// their weights. Unused entries weigh 0.
struct GridStencil {
    std::array<std::uint32_t, 6> point{};
    std::array<float, 6> weight{};
};

/// With an even number of segments quadratic triangles of 2 x 2 segments, else linear ones.
GridStencil gridStencil(const Vec2& place, std::uint32_t segments);

/// Exitance on the patches of a group: the unique sites' values, and for each patch which of them
/// make up its grid.
struct ExitanceGroup {
    std::vector<std::uint32_t> firstSite;  ///< per patch, into siteOf
    std::vector<std::uint8_t> segments;    ///< per patch, refined
    std::vector<std::uint16_t> siteOf;     ///< into values
    std::vector<Rgb> values;
    std::vector<ExitanceSlope> slopes;  ///< by value; empty where light leaves all ways alike

    Rgb at(std::uint32_t patch, const Vec2& inPatch) const;
    /// What it would be if all light left as that which goes `towards` (unit, space of the slopes).
    Rgb at(std::uint32_t patch, const Vec2& inPatch, const Vec3& towards) const;
};

}  // namespace sss
