#pragma once
#include "sss/base/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace sss {

/// A unit vector in 32 bits (octahedral map, 16 bits a coordinate; error below 0.004 degrees).
std::uint32_t encodeUnitVector(const Vec3& n);
Vec3 decodeUnitVector(std::uint32_t code);

/// One sample point of a body's surface: a cell of the surface seen as one node of a quadrature
/// rule. 28 bytes, as in the cache file.
struct SurfacePoint {
    Vec3 position{};           ///< centroid of the cell, mm, body space
    float areaMm2 = 0;         ///< of the cell; all cells sum to the area of the mesh
    std::uint32_t normal = 0;  ///< encodeUnitVector of the cell's mean normal
    std::uint32_t face =
        0;  ///< face that holds the anchor: the place on the mesh nearest the centroid
    std::uint16_t u = 0,
                  v = 0;  ///< barycentrics of the anchor in 1/65535 (second and third corner)

    Vec2 barycentrics() const {
        return {static_cast<float>(u) / 65535.0f, static_cast<float>(v) / 65535.0f};
    }
};
static_assert(sizeof(SurfacePoint) == 28);

class CloudGuard;

/// A cached cloud as the sums see it: points in Morton order and what enters at each.
struct CloudView {
    std::span<const SurfacePoint> points;
    std::span<const Rgb> irradiance;  ///< transmitted irradiance E of each point, W m^-2
    /// Of a cloud that lies in a file, to be asked before looking at points or nodes of its octree;
    /// null where all is known to be sound.
    std::shared_ptr<const CloudGuard> guard = nullptr;

    std::size_t size() const { return points.size(); }
    Rgb flux(std::size_t i) const { return irradiance[i] * points[i].areaMm2; }
    /// For those who look at all of it. Throws Error{BadInput} if its file is damaged.
    void needAll() const;
};

}  // namespace sss
