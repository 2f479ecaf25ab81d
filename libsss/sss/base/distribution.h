#pragma once
#include "sss/base/vec.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// A density on [0, 1) that is constant on n equal cells. Densities follow the rounded cumulative
/// table that sampling uses, so that sample and pdf agree exactly.
class PiecewiseConstant1D {
public:
    /// `weights` must be finite and >= 0, at least one; all zero means uniform.
    explicit PiecewiseConstant1D(std::span<const double> weights);

    struct Sample {
        float x;           ///< in [0, 1)
        float pdf;         ///< with respect to x
        std::size_t cell;  ///< never one of zero weight
        float within;      ///< position in the cell in [0, 1): a fresh uniform number
    };
    Sample sample(float u) const;
    /// Density at x in [0, 1).
    float pdf(float x) const { return pdfOfCell(cellOf(x)); }
    /// Probability of a cell.
    float mass(std::size_t cell) const { return cumulative_[cell + 1] - cumulative_[cell]; }
    std::size_t cellCount() const { return cumulative_.size() - 1; }
    /// Sum of the weights.
    double total() const { return total_; }

private:
    std::size_t cellOf(float x) const;
    std::size_t cellForSample(float u) const;
    float pdfOfCell(std::size_t cell) const { return mass(cell) * static_cast<float>(cellCount()); }
    std::vector<float> cumulative_;  ///< n + 1 values from 0 to 1
    /// How many of cumulative_[1 .. n-1] lie in the cells of [0, 1) before each: where to search.
    std::vector<std::uint32_t> guide_;
    double total_ = 0;
};

/// A density on the unit square that is constant on width x height equal cells, first row at y = 0.
class PiecewiseConstant2D {
public:
    /// Row by row; width * height weights, with the conditions of the one-dimensional one.
    PiecewiseConstant2D(std::size_t width, std::span<const double> weights);

    struct Sample {
        Vec2 position;  ///< in [0, 1)^2
        float pdf;      ///< with respect to area on the unit square
    };
    Sample sample(const Vec2& u) const;
    float pdf(const Vec2& position) const;

private:
    std::vector<PiecewiseConstant1D> rows_;
    PiecewiseConstant1D marginal_;
};

}  // namespace sss
