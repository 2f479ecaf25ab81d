#include "sss/integrate/smooth_boundary.h"

#include "sss/optics/fresnel.h"

namespace sss {
namespace {

struct Arrival {
    Vec3 along;
    Vec3 face;  // geometric normal against it
    float eta;  // inside / outside
    bool fromInside;
};

BoundaryEvent eventAt(const Arrival& arrival, const Vec3& normal, float u) {
    const auto& [along, face, eta, fromInside] = arrival;
    const float cosine = -glm::dot(normal, along);
    const float reflectance =
        fromInside ? fresnelReflectanceFromInside(cosine, eta) : fresnelReflectance(cosine, eta);
    BoundaryEvent event;
    event.isReflected = u < reflectance;
    event.isInside = event.isReflected == fromInside;
    event.side = event.isReflected ? face : -face;
    if (event.isReflected) {
        event.direction = along + 2.0f * cosine * normal;
    } else {
        const float beyond =
            fromInside ? refractedCosineFromInside(cosine, eta) : refractedCosine(cosine, eta);
        event.direction =
            refractedDirection(along, normal, cosine, beyond, fromInside ? 1.0f / eta : eta);
    }
    event.direction = glm::normalize(event.direction);
    return event;
}

}  // namespace

BoundaryEvent sampleBoundary(const SurfaceHit& hit, const Vec3& along, float eta, float u) {
    const bool fromInside = glm::dot(hit.geometricNormal, along) > 0;
    const float sign = fromInside ? -1.0f : 1.0f;
    const Arrival arrival{along, hit.geometricNormal * sign, eta, fromInside};
    const Vec3 shading = hit.shadingNormal * sign;
    if (glm::dot(shading, along) < 0) {
        const BoundaryEvent event = eventAt(arrival, shading, u);
        if (glm::dot(event.direction, event.side) > 0) return event;
    }
    return eventAt(arrival, arrival.face, u);
}

}  // namespace sss
