#pragma once
#include "sss/base/distribution.h"
#include "sss/base/vec.h"

#include <array>
#include <optional>
#include <string_view>

namespace sss {

enum class FilterKind { Box, Tent, Gaussian, BlackmanHarris };

/// One row a filter; the index is the FilterKind.
struct FilterInfo {
    std::string_view name;       ///< as in the scene file
    double defaultRadiusPixels;  ///< half width
    double (*shape)(double t);   ///< unnormalised value at t = x / radius, |t| <= 1
};
inline constexpr std::size_t kFilterCount = 4;
extern const std::array<FilterInfo, kFilterCount> kPixelFilters;

/// The filter called `name`; nothing if there is none.
std::optional<FilterKind> filterKind(std::string_view name);
inline const FilterInfo& filterInfo(FilterKind kind) {
    return kPixelFilters[static_cast<std::size_t>(kind)];
}

/// A separable pixel filter by importance sampling: each camera sample belongs to one pixel, its
/// offset from the pixel's centre is drawn from the filter's density, and its weight is 1
/// [Ernst et al. 2006, "Filter importance sampling"]. So pixels, and tiles, are independent.
class PixelFilter {
public:
    /// `radiusPixels` = 0 takes the filter's default.
    explicit PixelFilter(FilterKind kind, double radiusPixels = 0);
    /// Offset in pixels, each coordinate in [-radius, radius).
    Vec2 sample(const Vec2& u) const;
    double radiusPixels() const { return radiusPixels_; }

private:
    double radiusPixels_;
    bool isBox_;  // needs no table
    PiecewiseConstant1D table_;
};

}  // namespace sss
