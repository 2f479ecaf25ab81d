#pragma once
#include "sss/base/bounds.h"
#include "sss/base/vec.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace sss {

struct Ray {
    Vec3 origin{};
    Vec3 direction{};  ///< unit
    float tMin = 0.0f;
    float tMax = std::numeric_limits<float>::infinity();
    Vec3 at(float t) const { return origin + direction * t; }
};

struct Hit {
    float t = 0;                 ///< mm along the unit direction
    std::uint32_t geometry = 0;  ///< index in the order of addition
    std::uint32_t face = 0;
    float u = 0, v = 0;   ///< barycentrics of the face's second and third corner
    Vec3 normal{};        ///< unit geometric normal by the winding (not turned to the ray)
};

/// Bits of Ray queries: a geometry is seen if (its mask & the query's mask) != 0.
inline constexpr std::uint32_t kAllGeometry = 0xffffffffu;

/// All triangles of a scene behind Embree. Built once, then const and thread-safe.
class RayScene {
public:
    struct Geometry {
        std::span<const Vec3> positions;  ///< mm, scene space; copied
        std::span<const UVec3> faces;     ///< copied
        std::uint32_t mask = kAllGeometry;
    };
    explicit RayScene(std::span<const Geometry> geometries);
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    /// Nearest hit in (tMin, tMax); false if there is none.
    bool intersect(const Ray& ray, Hit& hit, std::uint32_t mask = kAllGeometry) const;
    /// Whether anything lies in (tMin, tMax).
    bool occluded(const Ray& ray, std::uint32_t mask = kAllGeometry) const;
    const Bounds& bounds() const { return bounds_; }

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    Bounds bounds_;
};

/// Moves a point on a surface off it along `normal` (towards where the next ray leaves), by a few
/// units in the last place of its largest coordinate [Waechter & Binder 2019, Ray Tracing Gems 6].
Vec3 offsetFromSurface(const Vec3& point, const Vec3& normal);

}  // namespace sss
