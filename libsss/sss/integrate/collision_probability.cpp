#include "sss/integrate/collision_probability.h"

#include "sss/base/parallel.h"
#include "sss/base/sampler.h"
#include "sss/base/warp.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/refraction.h"

#include <algorithm>
#include <atomic>
#include <limits>

namespace sss {
namespace {

constexpr std::size_t kPointsPerTask = 64;
// Directions a point. Where the first few all end within, so do the others.
constexpr std::uint32_t kDirections = 64, kFirstDirections = 4;
// Less than this of a beam is none.
constexpr float kFaintLight = 1e-3f;
constexpr float kFaintLightDepth = 6.9f;  // of which it is the exponential
constexpr int kMostPassages = 16;
constexpr std::uint64_t kSeed = 0xc0111dedull;

// Light that enters a body and goes straight on, reflected at the boundary, and fades
// (DiffusionConstants::fading).
class StraightLight {
public:
    StraightLight(const World& world, int body, const DiffusionConstants& medium)
        : world_(world),
          body_(body),
          eta_(static_cast<float>(
              world.materialOf(world.bodies()[static_cast<std::size_t>(body)]).medium.eta)) {
        double least = std::numeric_limits<double>::infinity();
        for (int c = 0; c < 3; ++c) {
            if (!medium.scatters[static_cast<std::size_t>(c)]) continue;
            fading_[c] = static_cast<float>(medium.fading[c]);
            enters_[c] = 1;
            least = std::min(least, medium.fading[c]);
        }
        reachMm_ = static_cast<float>(kFaintLightDepth / least);
    }

    // The share that leaves of diffuse light that enters at a place.
    Rgb leaving(const SurfaceHit& place, std::uint64_t seed) {
        const Frame frame(place.geometricNormal);
        const Vec3 origin = world_.leave(place, -place.geometricNormal);
        Rgb leaves(0);
        float entered = 0;
        for (std::uint32_t k = 0; k < kDirections; ++k) {
            if (k == kFirstDirections && maxComponent(leaves) <= kFaintLight * entered) break;
            Sampler sampler(seed, k);
            const Vec3 outside = cosineDirection(sampler.next2D());
            const float enters = 1.0f - fresnelReflectance(outside.z, eta_);
            const float cosine = refractedCosine(outside.z, eta_);
            if (!(enters > 0 && cosine > 0)) continue;
            entered += enters;
            const Vec3 along = refractedDirection(-frame.toWorld(outside), place.geometricNormal,
                                                  outside.z, cosine, eta_);
            leaves += enters * leavingAlong(origin, glm::normalize(along));
        }
        return entered > 0 ? leaves / entered : Rgb(0);
    }
    std::uint64_t rays() const { return rays_; }

private:
    Rgb leavingAlong(const Vec3& origin, const Vec3& direction) {
        Ray ray;
        ray.origin = origin;
        ray.direction = direction;
        ray.tMax = reachMm_;
        Rgb left = enters_, leaves(0);
        for (int leg = 0; leg < kMostPassages; ++leg) {
            Hit hit;
            ++rays_;
            if (!world_.rays().intersect(ray, hit, bodyMask(body_))) break;
            left *= glm::exp(-fading_ * hit.t);
            if (maxComponent(left) < kFaintLight) break;
            const SurfaceHit exit = world_.surfaceAt(hit);
            const float cosine = glm::dot(ray.direction, exit.geometricNormal);
            ray.origin = world_.leave(exit, -exit.geometricNormal);
            if (cosine <= 0) continue;  // the outside of another of the body's shells
            const float reflected = fresnelReflectanceFromInside(cosine, eta_);
            leaves += left * (1.0f - reflected);
            left *= reflected;
            ray.direction -= 2.0f * cosine * exit.geometricNormal;
        }
        return leaves;
    }

    const World& world_;
    int body_;
    float eta_, reachMm_ = 0;
    Rgb fading_{0.0f}, enters_{0.0f};
    std::uint64_t rays_ = 0;
};

}  // namespace

std::vector<Rgb> collisionProbabilities(const World& world, int body,
                                        std::span<const SurfacePoint> points,
                                        const DiffusionConstants& medium, CollisionCounts& counts) {
    std::vector<Rgb> collided(points.size(), Rgb(1));
    std::atomic<std::uint64_t> rays{0};
    parallelFor(points.size(), kPointsPerTask, [&](std::size_t begin, std::size_t end) {
        StraightLight light(world, body, medium);
        for (std::size_t i = begin; i < end; ++i) {
            const SurfaceHit place =
                world.surfaceOf(body, points[i].face, points[i].barycentrics());
            collided[i] = glm::max(Rgb(1) - light.leaving(place, combineSeeds(kSeed, i)),
                                   Rgb(kLeastCollided));
        }
        rays += light.rays();
    });
    counts.rays += rays;
    return collided;
}

}  // namespace sss
