#pragma once
#include "sss/base/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// The occupied cells of a regular grid over points, found by hashing; cells are numbered in order
/// of first appearance, so that numbering depends on the points only.
class CellGrid {
public:
    /// `cellSize` in mm; enlarged where the points span more than 2 million cells.
    CellGrid(std::span<const Vec3> positions, double cellSize);

    std::size_t cellCount() const { return keys_.size(); }
    std::uint32_t cellOf(std::size_t point) const { return cellOf_[point]; }
    /// In [0, 27): cells of one phase are at least two cells apart from each other.
    int phase(std::uint32_t cell) const;
    /// Occupied cells among the 27 around `cell`, itself included.
    std::span<const std::uint32_t> neighbours(std::uint32_t cell) const {
        return std::span(neighbours_)
            .subspan(firstNeighbour_[cell], firstNeighbour_[cell + 1] - firstNeighbour_[cell]);
    }

private:
    std::uint64_t keyOf(const Vec3& p) const;
    std::size_t slotOf(std::uint64_t key) const;
    std::uint32_t insert(std::uint64_t key);
    int find27(std::uint32_t cell, std::array<std::uint32_t, 27>& out) const;
    void listNeighbours();

    Vec3 origin_;
    double inverseSize_ = 1;
    std::vector<std::uint32_t> slots_;  // open addressing: cell, or kNoCell
    std::vector<std::uint64_t> keys_;   // of each cell
    std::vector<std::uint32_t> cellOf_;
    std::vector<std::uint32_t> firstNeighbour_, neighbours_;
};

}  // namespace sss
