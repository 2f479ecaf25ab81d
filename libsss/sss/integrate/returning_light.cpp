#include "sss/integrate/returning_light.h"

#include "sss/base/parallel.h"
#include "sss/base/warp.h"
#include "sss/cloud/nearest_points.h"
#include "sss/integrate/interreflection.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/refraction.h"

#include <algorithm>

namespace sss {
namespace {

constexpr std::size_t kPointsPerReturnTask = 256;
// Diffusion levels out what single points have by chance.
constexpr std::uint32_t kRays = 12;
// Of the nearest points to what a ray has met, the first that faces as it does stands for it.
constexpr std::size_t kNear = 4;

// What a ray met, until it is known which point stands there.
struct Met {
    std::uint32_t at;
    Vec3 place, normal;  // body space
    float share;
    std::uint32_t beam;
};

}  // namespace

ReturningLight::ReturningLight(const World& world, int bodyIndex, const BodyOptics& optics,
                               const BodyCloud::View& cloud)
    : cloud_(cloud),
      limit_(optics.diffuseAlbedo),
      bounces_(mayComeBack(world, bodyIndex) ? world.scene().quality.bounces : 0) {
    if (bounces_ == 0) return;
    const Body& body = world.bodies()[static_cast<std::size_t>(bodyIndex)];
    const RigidTransform bodyFromWorld = body.worldFromBody.inverse();
    const std::uint64_t seed = combineSeeds(combineSeeds(world.scene().quality.seed, 0x4e7u),
                                            static_cast<std::uint64_t>(bodyIndex));
    const auto inBody = [&](const Vec3& direction) {
        return Vec3(bodyFromWorld.transformDirection(DVec3(direction)));
    };
    const std::size_t count = cloud.cloud.points.size();
    std::vector<std::vector<Met>> parts((count + kPointsPerReturnTask - 1) / kPointsPerReturnTask);
    parallelFor(count, kPointsPerReturnTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const SurfacePoint& point = cloud.cloud.points[p];
            const SurfaceHit here = world.surfaceOf(bodyIndex, point.face, point.barycentrics());
            const Frame frame(here.geometricNormal);
            for (std::uint32_t k = 0; k < kRays; ++k) {
                Sampler sampler(seed, static_cast<std::uint32_t>(p) * kRays + k);
                const Vec3 local = cosineDirection(sampler.next2D());
                Ray ray;
                ray.origin = world.leave(here, here.geometricNormal);
                ray.direction = frame.toWorld(local);
                Hit found;
                if (!world.rays().intersect(ray, found)) continue;
                const SurfaceHit there = world.surfaceAt(found);
                const float leaving = -glm::dot(ray.direction, there.geometricNormal);
                if (there.body != bodyIndex || leaving <= 0) continue;
                const float entering = 1.0f - fresnelReflectance(local.z, optics.eta);
                const float inside = refractedCosine(local.z, optics.eta);
                const Vec3 along = refractedDirection(-ray.direction, here.geometricNormal, local.z,
                                                      inside, optics.eta);
                parts[begin / kPointsPerReturnTask].push_back(
                    {static_cast<std::uint32_t>(p),
                     Vec3(bodyFromWorld.transformPoint(DVec3(there.position))),
                     inBody(there.geometricNormal),
                     kPiF * optics.radiancePerExitance(leaving) * entering /
                         static_cast<float>(kRays),
                     encodeUnitVector(glm::normalize(inBody(along)))});
            }
        }
    });
    std::vector<Met> met;
    for (const std::vector<Met>& part : parts) met.insert(met.end(), part.begin(), part.end());
    if (met.empty()) return;
    std::vector<Vec3> positions, places;
    for (const SurfacePoint& p : cloud.cloud.points) positions.push_back(p.position);
    for (const Met& m : met) places.push_back(m.place);
    const std::size_t near = std::min(kNear, count);
    std::vector<std::uint32_t> nearest(near * met.size());
    NearestPoints(positions).query(places, near, nearest);
    for (std::size_t i = 0; i < met.size(); ++i) {
        const auto found = std::span(nearest).subspan(i * near, near);
        const auto facing = std::ranges::find_if(found, [&](std::uint32_t q) {
            return glm::dot(decodeUnitVector(cloud.cloud.points[q].normal), met[i].normal) > 0;
        });
        sights_.push_back({met[i].at, facing == found.end() ? found.front() : *facing, met[i].share,
                           met[i].beam});
    }
}

std::vector<DRgb> ReturningLight::gathered(std::span<const DRgb> exitance) const {
    std::vector<DRgb> sum(exitance.size(), DRgb(0));
    for (const Sight& sight : sights_) sum[sight.at] += double{sight.share} * exitance[sight.seen];
    return sum;
}

std::vector<Rgb> ReturningLight::irradiance(std::span<const Rgb> exitance) const {
    const std::span<const Rgb> before = cloud_.cloud.irradiance;
    std::vector<DRgb> sent(exitance.size());
    for (std::size_t i = 0; i < sent.size(); ++i)
        sent[i] = DRgb(exitance[i]) - DRgb(limit_ * before[i]);
    std::vector<DRgb> all(before.begin(), before.end());
    for (int bounce = 0; bounce < bounces_; ++bounce) {
        const std::vector<DRgb> more = gathered(sent);
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i] += more[i];
            sent[i] = DRgb(limit_) * more[i];
        }
    }
    std::vector<Rgb> found;
    found.reserve(all.size());
    for (const DRgb& value : all) found.emplace_back(glm::max(value, DRgb(0)));
    return found;
}

EnteredBeams ReturningLight::beams(const EnteredBeams& before,
                                   std::span<const Rgb> irradiance) const {
    EnteredBeams found = before;
    for (std::size_t first = 0, last = 0; first < sights_.size(); first = last) {
        const std::uint32_t at = sights_[first].at;
        while (last < sights_.size() && sights_[last].at == at) ++last;
        if (meanComponent(irradiance[at]) < 2 * meanComponent(cloud_.cloud.irradiance[at]))
            continue;
        const std::span<std::uint32_t> own = found.of(at);
        for (std::size_t k = 0; k < own.size(); ++k)
            own[k] = sights_[first + k * (last - first) / own.size()].beam;
    }
    return found;
}

}  // namespace sss
