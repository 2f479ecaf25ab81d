#include "sss/image/filter.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace sss {
namespace {

constexpr std::size_t kTableCells = 1024;

double box(double) { return 1.0; }

double tent(double t) { return 1.0 - std::abs(t); }

// Standard deviation a third of the radius, lowered so that it ends at 0.
double gaussian(double t) { return std::exp(-4.5 * t * t) - std::exp(-4.5); }

// The four-term window [Harris 1978], "minimum 4-term".
double blackmanHarris(double t) {
    const double phase = std::numbers::pi * (t + 1.0);
    return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) -
           0.01168 * std::cos(3 * phase);
}

std::vector<double> tabulated(double (*shape)(double)) {
    std::vector<double> weights(kTableCells);
    for (std::size_t i = 0; i < kTableCells; ++i) {
        const double t = (2.0 * static_cast<double>(i) + 1.0) / kTableCells - 1.0;
        weights[i] = std::fmax(0.0, shape(t));
    }
    return weights;
}

}  // namespace

const std::array<FilterInfo, kFilterCount> kPixelFilters{{
    {"box", 0.5, box},
    {"tent", 1.0, tent},
    {"gaussian", 1.5, gaussian},
    {"blackman-harris", 1.5, blackmanHarris},
}};

std::optional<FilterKind> filterKind(std::string_view name) {
    for (std::size_t i = 0; i < kFilterCount; ++i)
        if (kPixelFilters[i].name == name) return static_cast<FilterKind>(i);
    return std::nullopt;
}

PixelFilter::PixelFilter(FilterKind kind, double radiusPixels)
    : radiusPixels_(radiusPixels > 0 ? radiusPixels : filterInfo(kind).defaultRadiusPixels),
      isBox_(kind == FilterKind::Box),
      table_(tabulated(filterInfo(kind).shape)) {}

Vec2 PixelFilter::sample(const Vec2& u) const {
    const auto diameter = static_cast<float>(2.0 * radiusPixels_);
    if (isBox_) return (u - Vec2(0.5f)) * diameter;
    return {(table_.sample(u.x).x - 0.5f) * diameter, (table_.sample(u.y).x - 0.5f) * diameter};
}

}  // namespace sss
