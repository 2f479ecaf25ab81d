#pragma once
#include "sss/scene/scene.h"

#include <array>
#include <vector>

namespace sss {

/// Density, and three factors of emission, as cubics in s in [0, 1]: value(s) = sum of c[k] s^k.
/// What trilinear values are along a straight line within one cell.
struct DensityCubic {
    std::array<Vec4, 4> c{};  ///< x = density, y z w = factors of emission

    Vec4 at(float s) const { return ((c[3] * s + c[2]) * s + c[1]) * s + c[0]; }
    float densityAt(float s) const { return ((c[3].x * s + c[2].x) * s + c[1].x) * s + c[0].x; }
    /// Of the density from 0 to s.
    float integralTo(float s) const {
        return s * (c[0].x + s * (c[1].x / 2 + s * (c[2].x / 3 + s * c[3].x / 4)));
    }
    bool isConstant() const { return c[1] == Vec4(0) && c[2] == Vec4(0) && c[3] == Vec4(0); }
    static DensityCubic constant(float value) { return {{Vec4(value), {}, {}, {}}}; }
};

/// A lattice of values over the unit cube, interpolated trilinearly; the outermost nodes lie on the
/// faces of the cube.
class DensityGrid {
public:
    using Cell = std::array<int, 3>;

    /// `values`: by node, x fastest, `channels` (1 or 4) each; finite and >= 0.
    DensityGrid(const Cell& nodes, int channels, std::vector<float> values);
    /// Opens the file. Throws Error{Io}, or Error{BadInput} where its size is not that of the
    /// lattice or a value is negative or not finite.
    static DensityGrid read(const GridFile& file);

    const Cell& cells() const { return cells_; }
    std::size_t cellCount() const { return isEmpty_.size(); }
    std::size_t indexOf(const Cell& c) const {
        return (static_cast<std::size_t>(c[2]) * static_cast<std::size_t>(cells_[1]) +
                static_cast<std::size_t>(c[1])) *
                   static_cast<std::size_t>(cells_[0]) +
               static_cast<std::size_t>(c[0]);
    }
    Cell cellOf(std::size_t index) const;
    /// All its values are zero.
    bool isEmpty(const Cell& cell) const { return isEmpty_[indexOf(cell)] != 0; }
    /// The values along the straight line from `from` to `to`, both in `cell`.
    DensityCubic along(const Cell& cell, const Vec3& from, const Vec3& to) const;
    /// Mean of the values over a cell, exactly.
    Vec4 mean(const Cell& cell) const;

private:
    Vec4 node(int x, int y, int z) const;
    std::array<Vec4, 8> corners(const Cell& cell) const;

    Cell nodes_, cells_;
    int channels_;
    std::vector<float> values_;
    std::vector<unsigned char> isEmpty_;  // by cell
};

}  // namespace sss
