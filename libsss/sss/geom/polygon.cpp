#include "sss/geom/polygon.h"

#include <algorithm>
#include <numeric>

namespace sss {

namespace {

constexpr std::size_t kMaxEarCorners = 2'000;

/// Twice the signed area.
double cross2(const DVec2& a, const DVec2& b, const DVec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon seen along its area vector, which makes it counter-clockwise.
std::vector<DVec2> projected(std::span<const DVec3> corners) {
    DVec3 normal{0};
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    const DVec3 size = glm::abs(normal);
    const int w = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const int u = (w + 1) % 3, v = (w + 2) % 3;
    std::vector<DVec2> flat;
    flat.reserve(corners.size());
    for (const DVec3& p : corners) {
        const DVec3 d = p - corners[0];
        flat.push_back(normal[w] < 0 ? DVec2{d[v], d[u]} : DVec2{d[u], d[v]});
    }
    return flat;
}

bool isConvex(const std::vector<DVec2>& flat) {
    const std::size_t n = flat.size();
    for (std::size_t i = 0; i < n; ++i)
        if (cross2(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) < 0) return false;
    return true;
}

/// Whether corner b of the remaining polygon can be cut off.
bool isEar(const std::vector<DVec2>& flat, const std::vector<std::uint32_t>& left, std::size_t at) {
    const std::size_t n = left.size();
    const std::uint32_t ia = left[(at + n - 1) % n], ib = left[at], ic = left[(at + 1) % n];
    const DVec2 a = flat[ia], b = flat[ib], c = flat[ic];
    if (cross2(a, b, c) <= 0) return false;
    return std::none_of(left.begin(), left.end(), [&](std::uint32_t i) {
        const DVec2 p = flat[i];
        // Corners at the same place, as where a hole is tied to its rim, are no obstacle.
        if (p == a || p == b || p == c) return false;
        return cross2(a, b, p) >= 0 && cross2(b, c, p) >= 0 && cross2(c, a, p) >= 0;
    });
}

std::vector<UVec3> fan(std::size_t corners) {
    std::vector<UVec3> triangles;
    for (std::uint32_t i = 1; i + 1 < corners; ++i) triangles.emplace_back(0, i, i + 1);
    return triangles;
}

}  // namespace

std::vector<UVec3> triangulatePolygon(std::span<const DVec3> corners) {
    if (corners.size() <= 3 || corners.size() > kMaxEarCorners) return fan(corners.size());
    const std::vector<DVec2> flat = projected(corners);
    if (isConvex(flat)) return fan(corners.size());

    std::vector<std::uint32_t> left(corners.size());
    std::iota(left.begin(), left.end(), 0u);
    std::vector<UVec3> triangles;
    std::size_t at = 0, tried = 0;
    while (left.size() > 3) {
        at %= left.size();
        if (!isEar(flat, left, at)) {
            ++at;
            // No ear left: the polygon crosses itself.
            if (++tried > left.size()) return fan(corners.size());
            continue;
        }
        const std::size_t n = left.size();
        triangles.emplace_back(left[(at + n - 1) % n], left[at], left[(at + 1) % n]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
        tried = 0;
    }
    triangles.emplace_back(left[0], left[1], left[2]);
    return triangles;
}

}  // namespace sss
