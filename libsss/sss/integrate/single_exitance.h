#pragma once
#include "sss/cloud/surface_sampler.h"
#include "sss/integrate/path_tracer.h"

#include <span>
#include <vector>

namespace sss {

/// Radiant exitance, W m^-2, of light that has scattered exactly once in a body, at each of its
/// points: the mean over the point's cell and the directions outside of what single scattering adds
/// to a picture, by `samplesPerPoint` of its own estimates. Unbiased; a point's own noise is large
/// and wants smoothing. Parallel; deterministic.
std::vector<Rgb> singleExitance(const World& world, int body, const SurfaceSamples& samples,
                                const PathTracer& tracer, int samplesPerPoint, PathCounts& counts);

}  // namespace sss
