#pragma once
#include "sss/image/film.h"
#include "sss/integrate/bsdf.h"

namespace sss {

/// Writes what the first hit of a camera ray shows of the surface there: alpha, depth, normal and
/// albedo.
void describeFirstHit(const World& world, const Ray& ray, const SurfaceHit& hit, const Bsdf& bsdf,
                      FilmSample& sample);

}  // namespace sss
