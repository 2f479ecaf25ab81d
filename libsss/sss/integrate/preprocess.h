#pragma once
#include "sss/base/reporter.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/integrate/body_cloud.h"
#include "sss/integrate/path_tracer.h"
#include "sss/integrate/spacing.h"

#include <memory>
#include <string>
#include <vector>

namespace sss {

/// Optics of all bodies of a world, in their order.
std::vector<std::unique_ptr<BodyOptics>> makeBodyOptics(const World& world);

struct PreprocessLimits {
    std::size_t mostPoints = 20'000'000;  ///< per body; refused before any memory is taken
};

/// What pass 1 did for one body.
struct BodyReport {
    std::string name;
    std::size_t points = 0, nodes = 0;
    double areaMm2 = 0, spacingMm = 0;
    double expectedQuadratureError = 0;  ///< RMS, relative
    double irradianceNoise = 0;          ///< of a point, relative to the mean
    int irradianceSamples = 0;           ///< per point
    std::uint64_t nonFinite = 0;         ///< light samples dropped as NaN or infinite
    PathCounts counts;
};

/// Spacing that the points of a body get: the scene's own, or from tolerance and mean free path.
double pointSpacingMm(const World& world, const Body& body, const BodyOptics& optics);

// Pass 1 of one body, in its three steps. Each fills its part of the report.

/// Throws Error{Resource} over the limit. `placedOn`, if given, has the faces of the body's mesh in
/// another shape: there the points are placed, and carried to the body.
SurfaceSamples placePoints(const World& world, int body, const BodyOptics& optics,
                           const PreprocessLimits& limits, Reporter& reporter, BodyReport& report,
                           const TriangleMesh* placedOn = nullptr);
/// The part of the report that speaks of points, for those that were placed before.
void describePoints(const Body& body, const BodyOptics& optics, std::size_t points,
                    BodyReport& report);
/// In the space of World::inLightSpace(), so that the same light gives the same bytes.
std::vector<Rgb> lightPoints(const World& world, int body, const SurfaceSamples& samples,
                             std::span<const std::unique_ptr<BodyOptics>> optics,
                             Reporter& reporter, BodyReport& report);
BodyCloud buildCloud(SurfaceSamples samples, std::vector<Rgb> irradiance, BodyReport& report);

}  // namespace sss
