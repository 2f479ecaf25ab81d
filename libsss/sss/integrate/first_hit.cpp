#include "sss/integrate/first_hit.h"

namespace sss {

void describeFirstHit(const World& world, const Ray& ray, const SurfaceHit& hit, const Bsdf& bsdf,
                      FilmSample& sample) {
    sample.alpha = 1;
    sample.depth = hit.distance * glm::dot(ray.direction, world.camera().forward());
    sample.normal = bsdf.shadingNormal();
    sample.albedo = bsdf.albedo();
}

}  // namespace sss
