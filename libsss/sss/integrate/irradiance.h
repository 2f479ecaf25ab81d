#pragma once
#include "sss/base/reporter.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/integrate/entered_beams.h"
#include "sss/integrate/path_tracer.h"

#include <vector>

namespace sss {

struct IrradianceResult {
    std::vector<Rgb> irradiance;  ///< transmitted, per point, W m^-2
    int samplesPerPoint = 0;      ///< mean
    /// RMS over the points of the standard error of a point's irradiance, relative to the mean
    /// irradiance: from the spread of its samples as if they were independent, so an upper bound.
    double pointNoise = 0;
    EnteredBeams beams;           ///< if they were asked for
    std::uint64_t nonFinite = 0;  ///< samples dropped as NaN or infinite
    PathCounts counts;
};

/// Transmitted irradiance of every point of a body: direct light of all kinds with shadows, the
/// environment, and light by way of other surfaces, translucent ones in their diffuse limit, for
/// `bounces` bounces.
///
/// Samples are spread over a point's cell, so that what is cached is the mean over the cell: light
/// edges and facets inside a cell are integrated, not missed or hit.
///
/// The sum over points averages over all of them within reach of the profile (60 to 130 at the
/// default spacing), and neighbours share one stratified sequence, so few samples a point are
/// enough. The same number everywhere: giving dark and half-shadowed cells more, for the same sum
/// of samples, was measured to be worse, since what a receiver lacks is the noise of the bright.
///
/// `wantsBeams`: also which way the light goes on inside.
IrradianceResult computeIrradiance(const World& world, int body, const SurfaceSamples& samples,
                                   const PathTracer& tracer, Reporter& reporter,
                                   bool wantsBeams = false);

/// Samples a point gets: the scene's own number, or by tolerance.
int irradianceSamplesFor(const QualitySettings& quality);

}  // namespace sss
