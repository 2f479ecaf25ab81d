#pragma once
#include "sss/image/film.h"
#include "sss/integrate/path_tracer.h"

namespace sss {

/// A way to find what the camera sees. Const and thread-safe.
class Integrator {
public:
    virtual ~Integrator() = default;
    /// One estimate of the radiance along a camera ray, by layer.
    virtual FilmSample trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const = 0;
};

}  // namespace sss
