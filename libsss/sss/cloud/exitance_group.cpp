#include "sss/cloud/exitance_group.h"

#include <algorithm>

namespace sss {
namespace {

// Of the exitance, by how much light leans at most: first order says nothing of more.
constexpr float kMostLean = 0.6f;

// A triangle of the grid with corners at even steps: where it lies, and the place in it.
struct Element {
    std::uint32_t i, j;  // its corner of the right angle, in elements
    bool inverted;       // then that corner is the one at (i + 1, j + 1)
    float x, y;
};

Element elementAt(const Vec2& place, std::uint32_t n) {
    const Vec2 scaled = place * static_cast<float>(n);
    std::uint32_t i = std::min(static_cast<std::uint32_t>(scaled.x), n - 1);
    std::uint32_t j = std::min(static_cast<std::uint32_t>(scaled.y), n - 1);
    while (i + j > n - 1) (i > 0 ? i : j) -= 1;
    const float x = scaled.x - static_cast<float>(i), y = scaled.y - static_cast<float>(j);
    if (x + y <= 1.0f || i + j == n - 1) return {i, j, false, x, y};
    return {i, j, true, 1.0f - x, 1.0f - y};
}

GridStencil linearStencil(const Vec2& place, std::uint32_t n) {
    const auto [i, j, inverted, x, y] = elementAt(place, n);
    GridStencil stencil;
    stencil.weight = {1.0f - x - y, x, y};
    if (inverted)
        stencil.point = {gridIndex(i + 1, j + 1, n), gridIndex(i, j + 1, n),
                         gridIndex(i + 1, j, n)};
    else
        stencil.point = {gridIndex(i, j, n), gridIndex(i + 1, j, n), gridIndex(i, j + 1, n)};
    return stencil;
}

GridStencil quadraticStencil(const Vec2& place, std::uint32_t n) {
    const auto [i, j, inverted, x, y] = elementAt(place, n / 2);
    const float z = 1.0f - x - y;
    GridStencil stencil;
    // Corners, then the middles between first and second, second and third, third and first.
    stencil.weight = {z * (2 * z - 1), x * (2 * x - 1), y * (2 * y - 1),
                      4 * z * x,       4 * x * y,       4 * y * z};
    const std::uint32_t a = 2 * i, b = 2 * j;
    if (inverted)
        stencil.point = {gridIndex(a + 2, b + 2, n), gridIndex(a, b + 2, n),
                         gridIndex(a + 2, b, n),     gridIndex(a + 1, b + 2, n),
                         gridIndex(a + 1, b + 1, n), gridIndex(a + 2, b + 1, n)};
    else
        stencil.point = {gridIndex(a, b, n),         gridIndex(a + 2, b, n),
                         gridIndex(a, b + 2, n),     gridIndex(a + 1, b, n),
                         gridIndex(a + 1, b + 1, n), gridIndex(a, b + 1, n)};
    return stencil;
}

// Sum over a stencil of what `valueAt` gives at its points.
template <typename ValueAt>
Rgb interpolate(const GridStencil& stencil, std::uint32_t segments, const ValueAt& valueAt) {
    const std::size_t count = segments % 2 == 0 ? 6 : 3;
    Rgb sum(0.0f);
    for (std::size_t k = 0; k < count; ++k) sum += valueAt(stencil.point[k]) * stencil.weight[k];
    return sum;
}

}  // namespace

GridStencil gridStencil(const Vec2& place, std::uint32_t segments) {
    // The most frequent grids are a single triangle each: without the search for it.
    const float x = place.x, y = place.y, z = 1.0f - x - y;
    if (segments == 1) return {{0, 1, 2}, {z, x, y}};
    if (segments == 2)
        return {
            {0, 2, 5, 1, 4, 3},
            {z * (2 * z - 1), x * (2 * x - 1), y * (2 * y - 1), 4 * z * x, 4 * x * y, 4 * y * z}};
    return segments % 2 == 0 ? quadraticStencil(place, segments) : linearStencil(place, segments);
}

Rgb ExitanceGroup::at(std::uint32_t patch, const Vec2& inPatch) const {
    const std::uint32_t n = segments[patch];
    const std::uint16_t* site = siteOf.data() + firstSite[patch];
    // Parabolas may undershoot where the light ends.
    return glm::max(interpolate(gridStencil(inPatch, n), n,
                                [&](std::uint32_t point) { return values[site[point]]; }),
                    Rgb(0.0f));
}

Rgb ExitanceGroup::at(std::uint32_t patch, const Vec2& inPatch, const Vec3& towards) const {
    const Rgb value = at(patch, inPatch);
    if (slopes.empty()) return value;
    const std::uint32_t n = segments[patch];
    const std::uint16_t* site = siteOf.data() + firstSite[patch];
    const Rgb lean = interpolate(gridStencil(inPatch, n), n, [&](std::uint32_t point) {
        return slopes[site[point]].along(towards);
    });
    return value + glm::clamp(lean, -kMostLean * value, kMostLean * value);
}

}  // namespace sss
