#include "sss/integrate/rough_boundary.h"

#include <algorithm>

namespace sss {
namespace {

constexpr float kGrazing = 1e-4f;

Vec3 shadingNormal(const SurfaceHit& hit, float sign, const Vec3& along) {
    const Vec3 shading = hit.shadingNormal * sign;
    return glm::dot(shading, along) < -kGrazing ? shading : hit.geometricNormal * sign;
}

float sideOf(const SurfaceHit& hit, const Vec3& along) {
    return glm::dot(hit.geometricNormal, along) > 0 ? -1.0f : 1.0f;
}

}  // namespace

RoughBoundary::RoughBoundary(const SurfaceHit& hit, const Vec3& along, float eta, const Ggx& ggx)
    : along_(along),
      fromInside_(sideOf(hit, along) < 0),
      face_(hit.geometricNormal * sideOf(hit, along)),
      shading_(shadingNormal(hit, sideOf(hit, along), along)),
      isBent_(shading_.normal != face_.normal),
      surface_(ggx, fromInside_ ? 1.0f / eta : eta) {}

bool RoughBoundary::keepsSide(const Frame& frame, const Vec3& direction) const {
    return glm::dot(frame.normal, direction) * glm::dot(face_.normal, direction) > 0;
}

Vec3 RoughBoundary::sampleAbout(const Frame& frame, Sampler& sampler) const {
    Vec3 wo = frame.toLocal(-along_);
    wo.z = std::max(wo.z, kGrazing);
    return glm::normalize(frame.toWorld(surface_.sample(glm::normalize(wo), sampler).direction));
}

float RoughBoundary::densityAbout(const Frame& frame, const Vec3& direction,
                                  Sampler& sampler) const {
    Vec3 wo = frame.toLocal(-along_);
    wo.z = std::max(wo.z, kGrazing);
    return surface_.density(glm::normalize(wo), frame.toLocal(direction), sampler);
}

BoundaryEvent RoughBoundary::sample(Sampler& sampler) const {
    BoundaryEvent event;
    event.direction = sampleAbout(shading_, sampler);
    if (isBent_ && !keepsSide(shading_, event.direction))
        event.direction = sampleAbout(face_, sampler);
    event.isReflected = glm::dot(face_.normal, event.direction) > 0;
    event.isInside = event.isReflected == fromInside_;
    event.side = event.isReflected ? face_.normal : -face_.normal;
    return event;
}

float RoughBoundary::density(const Vec3& direction, Sampler& sampler) const {
    float sum = keepsSide(shading_, direction) ? densityAbout(shading_, direction, sampler) : 0;
    // What would be sent to the wrong side is sent by the face.
    if (isBent_ && !keepsSide(shading_, sampleAbout(shading_, sampler)))
        sum += densityAbout(face_, direction, sampler);
    return sum;
}

}  // namespace sss
