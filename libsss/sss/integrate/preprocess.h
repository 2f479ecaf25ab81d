#pragma once
#include "sss/base/reporter.h"
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
    PathCounts counts;
    double secondsPoints = 0, secondsIrradiance = 0, secondsOctree = 0;
};

/// Spacing that the points of a body get: the scene's own, or from tolerance and mean free path.
double pointSpacingMm(const World& world, const Body& body, const BodyOptics& optics);

/// Pass 1 of one body: points, irradiance, octree. Throws Error{Resource} over the limit.
BodyCloud preprocessBody(const World& world, int body,
                         std::span<const std::unique_ptr<BodyOptics>> optics,
                         const PreprocessLimits& limits, Reporter& reporter, BodyReport& report);

}  // namespace sss
