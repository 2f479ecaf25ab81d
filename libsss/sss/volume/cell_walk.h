#pragma once
#include "sss/volume/density_grid.h"
#include "sss/volume/volume_region.h"

#include <cmath>
#include <limits>

namespace sss {

/// Calls visit(cell, begin, end) for the cells that a line meets within `inside`, in order. The
/// line and the lattice are those of the unit cube [Amanatides and Woo 1987].
template <typename Visit>
void walkCells(const DensityGrid::Cell& cells, const UnitLine& line, const RayInterval& inside,
               const Visit& visit) {
    DensityGrid::Cell cell{};
    std::array<int, 3> step{};
    std::array<double, 3> next{}, perCell{};
    const DVec3 start = line.at(inside.begin);
    for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<int>(a);
        const double n = cells[a], o = line.origin[axis] * n, d = line.direction[axis] * n;
        cell[a] = std::clamp(static_cast<int>(std::floor(start[axis] * n)), 0, cells[a] - 1);
        step[a] = d > 0 ? 1 : -1;
        perCell[a] = d != 0 ? std::abs(1 / d) : std::numeric_limits<double>::infinity();
        next[a] =
            d != 0 ? (cell[a] + (d > 0 ? 1 : 0) - o) / d : std::numeric_limits<double>::infinity();
    }
    double t = inside.begin;
    while (t < inside.end) {
        const std::size_t a =
            next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        const double end = std::min(next[a], inside.end);
        if (end > t) visit(cell, t, end);
        t = std::max(t, end);
        cell[a] += step[a];
        if (cell[a] < 0 || cell[a] >= cells[a]) return;
        next[a] += perCell[a];
    }
}

}  // namespace sss
