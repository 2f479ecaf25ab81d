#pragma once
#include "sss/base/bounds.h"

#include <algorithm>
#include <cstdint>

namespace sss {

inline constexpr int kMortonBits = 21;  ///< per axis; 63 in all

/// Places points on the Z-order curve of a cube around `bounds`.
class MortonGrid {
public:
    explicit MortonGrid(const Bounds& bounds) : origin_(bounds.lo) {
        const double side = std::max<double>(maxComponent(bounds.size()), 1e-30);
        scale_ = static_cast<double>(1u << kMortonBits) / side;
    }
    std::uint64_t code(const Vec3& p) const {
        return spread(cell(p.x, origin_.x)) | spread(cell(p.y, origin_.y)) << 1 |
               spread(cell(p.z, origin_.z)) << 2;
    }

private:
    std::uint64_t cell(double x, double origin) const {
        const double top = (1u << kMortonBits) - 1;
        return static_cast<std::uint64_t>(std::clamp((x - origin) * scale_, 0.0, top));
    }
    /// Puts two zero bits between the 21 bits of `x`.
    static constexpr std::uint64_t spread(std::uint64_t x) {
        x = (x | x << 32) & 0x001f00000000ffffull;
        x = (x | x << 16) & 0x001f0000ff0000ffull;
        x = (x | x << 8) & 0x100f00f00f00f00full;
        x = (x | x << 4) & 0x10c30c30c30c30c3ull;
        return (x | x << 2) & 0x1249249249249249ull;
    }

    Vec3 origin_;
    double scale_;
};

}  // namespace sss
