#include "sss/integrate/beam_sources.h"

#include "sss/base/parallel.h"
#include "sss/optics/fresnel.h"
#include "sss/shape/depth_rule.h"

#include <cmath>
#include <limits>

namespace sss {
namespace {

constexpr std::size_t kPointsPerBeamTask = 256;
// A beam that is reflected inside goes on until this much of it is left.
constexpr double kFaintBeam = 1e-4;
constexpr int kMostBeamLegs = 16;

// One beam on its way.
class BeamWalk {
public:
    BeamWalk(const World& world, int body, const DiffusionConstants& medium, const DepthRule& rule)
        : world_(world),
          body_(body),
          eta_(static_cast<float>(
              world.materialOf(world.bodies()[static_cast<std::size_t>(body)]).medium.eta)),
          medium_(medium),
          rule_(rule),
          place_(world.bodies()[static_cast<std::size_t>(body)].worldFromBody),
          back_(place_.inverse()) {}

    // The beams of one point (body space), each with its part of `power`. Appends to `out`.
    void follow(std::uint32_t index, const SurfacePoint& point,
                std::span<const std::uint32_t> beams, const DRgb& power, BeamSources& out) {
        point_ = index;
        const SurfaceHit start = world_.surfaceOf(body_, point.face, point.barycentrics());
        Ray ray;
        ray.origin = world_.leave(start, -start.geometricNormal);
        const DRgb share = power / static_cast<double>(beams.size());
        // Beams that stay inside are one, along their mean direction: their sources keep power and
        // centre. Each for itself would be four times as many.
        Vec3 within{0};
        DRgb powerWithin{0};
        for (const std::uint32_t beam : beams) {
            ray.direction = Vec3(place_.transformDirection(DVec3(decodeUnitVector(beam))));
            if (follow(ray, share, out)) continue;
            within += ray.direction;
            powerWithin += share;
        }
        if (!(maxComponent(powerWithin) > 0)) return;
        const double count = maxComponent(powerWithin) / maxComponent(share);
        ray.direction = within / static_cast<float>(count);
        place(ray, std::numeric_limits<double>::infinity(), powerWithin, point_, out);
    }

private:
    // False, and nothing done, for a beam that never leaves the body.
    bool follow(Ray ray, const DRgb& power, BeamSources& out) {
        DRgb left = power;
        for (int leg = 0;
             leg < kMostBeamLegs && maxComponent(left) > kFaintBeam * maxComponent(power); ++leg) {
            ray.tMax = static_cast<float>(rule_.reachMm());
            Hit hit;
            const bool leaves = world_.rays().intersect(ray, hit, bodyMask(body_));
            const double length =
                leaves ? static_cast<double>(hit.t) : std::numeric_limits<double>::infinity();
            if (!leaves && leg == 0) return false;
            place(ray, length, left, leg == 0 ? point_ : VolumeSource::kNowhere, out);
            if (!leaves) return true;
            left *= glm::exp(-medium_.extinction * length);
            const SurfaceHit exit = world_.surfaceAt(hit);
            const float cosine = glm::dot(ray.direction, exit.geometricNormal);
            if (cosine <= 0) {  // the outside of another of the body's shells: it goes on
                ray.origin = world_.leave(exit, -exit.geometricNormal);
                continue;
            }
            const double reflected = fresnelReflectanceFromInside(double{cosine}, double{eta_});
            out.unscattered += left * (1.0 - reflected);
            left *= reflected;
            ray.origin = world_.leave(exit, -exit.geometricNormal);
            ray.direction -= 2.0f * cosine * exit.geometricNormal;
        }
        return true;
    }

    void place(const Ray& ray, double length, const DRgb& power, std::uint32_t from,
               BeamSources& out) {
        nodes_.clear();
        rule_.append(length, nodes_);
        for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
            const DepthRule::Node& node = nodes_[k];
            const DRgb source = power * node.weight * medium_.reducedAlbedo;
            const DVec3 at = DVec3(ray.origin) + DVec3(ray.direction) * node.depthMm;
            out.sources.push_back({Vec3(back_.transformPoint(at)), Rgb(source), k, from});
            out.scattered += source;
        }
    }

    const World& world_;
    int body_;
    float eta_;
    const DiffusionConstants& medium_;
    const DepthRule& rule_;
    RigidTransform place_, back_;
    std::uint32_t point_ = 0;  // of the cloud
    std::vector<DepthRule::Node> nodes_;
};

}  // namespace

BeamSources placeBeamSources(const World& world, int body, const BodyCloud::View& cloud,
                             const EnteredBeams& beams, const DiffusionConstants& medium) {
    const DepthRule rule(medium);
    const std::size_t count = cloud.cloud.points.size();
    std::vector<BeamSources> parts((count + kPointsPerBeamTask - 1) / kPointsPerBeamTask);
    parallelFor(count, kPointsPerBeamTask, [&](std::size_t begin, std::size_t end) {
        BeamSources& part = parts[begin / kPointsPerBeamTask];
        BeamWalk walk(world, body, medium, rule);
        for (std::size_t p = begin; p < end; ++p) {
            const DRgb power =
                DRgb(cloud.cloud.irradiance[p]) * double{cloud.cloud.points[p].areaMm2};
            part.entered += power;
            if (!(maxComponent(power) > 0)) continue;
            walk.follow(static_cast<std::uint32_t>(p), cloud.cloud.points[p], beams.of(p), power,
                        part);
        }
    });
    BeamSources all;
    for (const BeamSources& part : parts) {
        all.sources.insert(all.sources.end(), part.sources.begin(), part.sources.end());
        all.entered += part.entered;
        all.scattered += part.scattered;
        all.unscattered += part.unscattered;
    }
    return all;
}

}  // namespace sss
