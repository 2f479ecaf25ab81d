#include "sss/integrate/entered_beams.h"

#include "sss/cloud/point_cloud.h"
#include "sss/integrate/smooth_boundary.h"
#include "sss/optics/fresnel.h"

namespace sss {

void BeamPicker::clear() {
    candidates_.clear();
    total_ = 0;
}

void BeamPicker::add(const IrradianceEstimator::Arrival& light, const Vec3& normal) {
    const float brought = meanComponent(light.irradiance);
    if (!(brought > 0)) return;
    total_ += brought;
    candidates_.push_back({total_, light.from, normal});
}

void BeamPicker::add(const SurfaceHit& hit, const IrradianceEstimator::Arrivals& light) {
    const Vec3 normal = IrradianceEstimator::normalOf(hit);
    add(light.direct, normal);
    add(light.scattered, normal);
}

void BeamPicker::pick(std::span<std::uint32_t> beams) const {
    std::size_t next = 0;
    for (std::size_t b = 0; b < beams.size(); ++b) {
        beams[b] = encodeUnitVector({0, 0, 1});
        if (candidates_.empty()) continue;
        const float target =
            total_ * (static_cast<float>(b) + 0.5f) / static_cast<float>(beams.size());
        while (next + 1 < candidates_.size() && candidates_[next].upTo < target) ++next;
        const Candidate& picked = candidates_[next];
        const float outside = glm::dot(picked.from, picked.normal);
        const float inside = refractedCosine(outside, eta_);
        const Vec3 along = refractedDirection(-picked.from, picked.normal, outside, inside, eta_);
        beams[b] =
            encodeUnitVector(glm::normalize(Vec3(bodyFromWorld_.transformDirection(DVec3(along)))));
    }
}

}  // namespace sss
