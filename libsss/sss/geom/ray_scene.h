#pragma once
#include "sss/base/bounds.h"
#include "sss/base/vec.h"

#include <cstdint>
#include <functional>
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
    float u = 0, v = 0;  ///< barycentrics of the face's second and third corner
    Vec3 normal{};       ///< unit geometric normal by the winding (not turned to the ray)
};

/// What Hit::geometry says where a ray of several hit nothing.
inline constexpr std::uint32_t kNoGeometry = 0xffffffffu;

/// Bits of Ray queries: a geometry is seen if (its mask & the query's mask) != 0.
inline constexpr std::uint32_t kAllGeometry = 0xffffffffu;

/// All triangles of a scene behind Embree. Built once, then const and thread-safe.
///
/// No ray slips through an edge that two faces share (Embree's robust mode; without it, 5 % of the
/// rays aimed exactly at an edge do). Of rays aimed exactly at a vertex about 1 % pass. Which of
/// two faces a ray on their edge hits does not depend on the number of threads.
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
    /// Calls visit for every hit in (tMin, tMax), in an order of no meaning but always the same, in
    /// one traversal: no face is missed or met twice by stepping from hit to hit. `visit` must not
    /// throw.
    void forEachHit(const Ray& ray, const std::function<void(const Hit&)>& visit,
                    std::uint32_t mask = kAllGeometry) const;
    /// How several rays lie: they go the same way too, like those through one pixel, or just start
    /// close to one another.
    enum class Together { Parallel, Parted };
    /// intersect() for several rays, cheaper together. Hits of rays that hit nothing have
    /// kNoGeometry. `masks` by ray, or none if every ray sees all geometry.
    void intersectTogether(std::span<const Ray> rays, Together together, std::span<Hit> hits,
                           std::span<const std::uint32_t> masks = {}) const;
    /// occluded() for several rays, likewise.
    void occludedTogether(std::span<const Ray> rays, Together together, std::span<bool> occluded,
                          std::span<const std::uint32_t> masks = {}) const;
    const Bounds& bounds() const { return bounds_; }

    /// Where a hit lies, and where the next ray starts.
    struct Place {
        /// From the face's corners: as exact as they are, however far away the ray started
        /// (ray.at(t) carries the rounding of the whole way).
        Vec3 position;
        /// 64 units in the last place of the face's largest corner coordinate, mm. Unlike
        /// offsetFromSurface it knows the face, so it holds at any scale and close to the origin
        /// too.
        float step;
        /// The position moved off its face along the unit `normal`.
        Vec3 leave(const Vec3& normal) const { return position + normal * step; }
    };
    Place place(const Hit& hit) const;
    Vec3 position(const Hit& hit) const { return place(hit).position; }
    Vec3 leave(const Hit& hit, const Vec3& normal) const { return place(hit).leave(normal); }

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    Bounds bounds_;
};

/// Moves a point on a surface off it along the unit `normal` (towards where the next ray leaves),
/// by 64 units in the last place of its largest coordinate, and by 2^-16 mm at least, in the manner
/// of [Waechter & Binder 2019, Ray Tracing Gems 6]. For points whose face is not at hand; where
/// there is a Hit, RayScene::leave is tighter. The step is one length along the normal, not one per
/// axis as in the article: there a coordinate near zero gets a step smaller than the point's error.
Vec3 offsetFromSurface(const Vec3& point, const Vec3& normal);

}  // namespace sss
