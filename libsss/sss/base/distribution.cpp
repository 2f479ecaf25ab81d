#include "sss/base/distribution.h"

#include "sss/base/assert.h"

#include <algorithm>
#include <numeric>

namespace sss {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1f;

std::vector<PiecewiseConstant1D> makeRows(std::size_t width, std::span<const double> weights) {
    std::vector<PiecewiseConstant1D> rows;
    rows.reserve(weights.size() / width);
    for (std::size_t begin = 0; begin + width <= weights.size(); begin += width)
        rows.emplace_back(weights.subspan(begin, width));
    return rows;
}

std::vector<double> rowTotals(const std::vector<PiecewiseConstant1D>& rows) {
    std::vector<double> totals;
    totals.reserve(rows.size());
    for (const PiecewiseConstant1D& row : rows) totals.push_back(row.total());
    return totals;
}

}  // namespace

PiecewiseConstant1D::PiecewiseConstant1D(std::span<const double> weights) {
    SSS_ASSERT_GE(weights.size(), std::size_t{1});
    for (const double weight : weights) total_ += weight;
    cumulative_.reserve(weights.size() + 1);
    cumulative_.push_back(0.0f);
    const bool uniform = !(total_ > 1e-300);  // its inverse must be finite
    const double scale = 1.0 / (uniform ? static_cast<double>(weights.size()) : total_);
    double sum = 0;
    for (const double weight : weights) {
        sum += uniform ? 1.0 : weight;
        cumulative_.push_back(std::min(1.0f, static_cast<float>(sum * scale)));
    }
    // The cells after the last positive one keep no mass when the end is rounded up to 1.
    const float end = cumulative_.back();
    for (auto value = cumulative_.rbegin(); value != cumulative_.rend() && *value == end; ++value)
        *value = 1.0f;

    guide_.assign(weights.size() + 1, 0);
    for (std::size_t i = 1; i < weights.size(); ++i) ++guide_[cellOf(cumulative_[i]) + 1];
    std::partial_sum(guide_.begin(), guide_.end(), guide_.begin());
}

std::size_t PiecewiseConstant1D::cellForSample(float u) const {
    // cellOf() never decreases, so values in earlier cells are below u and in later ones above.
    const std::size_t cell = cellOf(u);
    const auto inner = cumulative_.begin() + 1;
    const auto above = std::upper_bound(inner + guide_[cell], inner + guide_[cell + 1], u);
    return static_cast<std::size_t>(above - inner);
}

PiecewiseConstant1D::Sample PiecewiseConstant1D::sample(float u) const {
    const std::size_t cell = cellForSample(u);
    const float share = mass(cell);
    const float within = share > 0 ? std::min((u - cumulative_[cell]) / share, kBelowOne) : 0.5f;
    const auto count = static_cast<float>(cellCount());
    float x = (static_cast<float>(cell) + within) / count;
    // Rounding must not carry x into the next cell, whose density is another.
    while (cellOf(x) > cell || x >= 1.0f) x = std::nextafter(x, 0.0f);
    while (cellOf(x) < cell) x = std::nextafter(x, 1.0f);
    return {x, pdfOfCell(cell), cell, within};
}

std::size_t PiecewiseConstant1D::cellOf(float x) const {
    const float scaled = std::max(x, 0.0f) * static_cast<float>(cellCount());
    return std::min(static_cast<std::size_t>(scaled), cellCount() - 1);
}

PiecewiseConstant2D::PiecewiseConstant2D(std::size_t width, std::span<const double> weights)
    : rows_(makeRows(width, weights)), marginal_(rowTotals(rows_)) {}

PiecewiseConstant2D::Sample PiecewiseConstant2D::sample(const Vec2& u) const {
    const PiecewiseConstant1D::Sample y = marginal_.sample(u.y);
    const PiecewiseConstant1D::Sample x = rows_[y.cell].sample(u.x);
    return {{x.x, y.x}, x.pdf * y.pdf};
}

float PiecewiseConstant2D::pdf(const Vec2& position) const {
    const auto count = static_cast<float>(rows_.size());
    const auto row =
        std::min(static_cast<std::size_t>(std::max(position.y, 0.0f) * count), rows_.size() - 1);
    return rows_[row].pdf(position.x) * marginal_.pdf(position.y);
}

}  // namespace sss
