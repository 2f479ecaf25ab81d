#pragma once
#include "sss/base/memory.h"
#include "sss/base/reporter.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/integrate/body_cloud.h"
#include "sss/integrate/irradiance.h"
#include "sss/integrate/path_tracer.h"
#include "sss/integrate/shape_exitance.h"
#include "sss/integrate/spacing.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sss {

/// Optics of all bodies of a world, in their order.
std::vector<std::unique_ptr<BodyOptics>> makeBodyOptics(const World& world);

/// What pass 1 takes for a point at its peak, while it places them (tests/bench/README.md: 5.2 GB
/// for 10^7).
inline constexpr std::uint64_t kBytesPerPoint = 520;

struct PreprocessLimits {
    // Per body; what is over is refused before any memory is taken for it.
    std::size_t mostPoints = 20'000'000;
    std::uint64_t mostBytes = memoryLimitBytes();  ///< by kBytesPerPoint
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
    /// Of what enters, of the channel with most of it; none unless solved on the shape.
    std::optional<double> unscatteredShare;
    std::optional<ShapeExitance> shape;  ///< without what was solved; none if it comes from a cache
};

/// Spacing that the points of a body get: the scene's own, or from tolerance and mean free path.
double pointSpacingMm(const World& world, const Body& body, const BodyOptics& optics);

/// About how many points that makes; `placedOn` as in placePoints().
std::size_t expectedPoints(const World& world, const Body& body, const BodyOptics& optics,
                           const TriangleMesh* placedOn = nullptr);

// Pass 1 of one body, in its steps. Each fills its part of the report.

/// Throws Error{Resource} over the limit. `placedOn`, if given, has the faces of the body's mesh in
/// another shape: there the points are placed, and carried to the body.
SurfaceSamples placePoints(const World& world, int body, const BodyOptics& optics,
                           const PreprocessLimits& limits, Reporter& reporter, BodyReport& report,
                           const TriangleMesh* placedOn = nullptr);
/// The part of the report that speaks of points, for those that were placed before.
void describePoints(const Body& body, const BodyOptics& optics, std::size_t points,
                    BodyReport& report);
/// In the space of World::inLightSpace(), so that the same light gives the same bytes. With beams
/// where diffusion is solved on the shape.
IrradianceResult lightPoints(const World& world, int body, const SurfaceSamples& samples,
                             std::span<const std::unique_ptr<BodyOptics>> optics,
                             Reporter& reporter, BodyReport& report);
BodyCloud buildCloud(const SurfaceSamples& samples, std::vector<Rgb> irradiance,
                     BodyReport& report);
/// Beams of samples as the points of their cloud stand.
EnteredBeams beamsInOrder(const SurfaceSamples& samples, EnteredBeams beams);
/// Diffusion on the shape of a body that asks for it (BodyOptics::onShape), by point of its
/// cloud, in the space of lightPoints(). `beams` by the cloud's points.
std::vector<SolvedExitance> shapeSolution(const World& world, int body,
                                          const SurfaceSamples& samples, const EnteredBeams& beams,
                                          std::span<const std::unique_ptr<BodyOptics>> optics,
                                          const BodyCloud::View& cloud, Reporter& reporter,
                                          BodyReport& report);

}  // namespace sss
