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

    /// The most rays that are traced together.
    static constexpr std::size_t kMostViews = PathTracer::kMostViews;
    /// The same for rays that lie close together, such as those of one pixel, each with its
    /// numbers.
    virtual void traceAll(std::span<const Ray> rays, std::span<Sampler> samplers,
                          std::span<FilmSample> seen, PathCounts& counts) const {
        for (std::size_t i = 0; i < rays.size(); ++i) seen[i] = trace(rays[i], samplers[i], counts);
    }
};

}  // namespace sss
