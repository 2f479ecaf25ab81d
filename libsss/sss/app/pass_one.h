#pragma once
#include "sss/app/run_stats.h"
#include "sss/integrate/preprocess.h"

#include <span>
#include <vector>

namespace sss {

struct PassOne {
    std::vector<BodyCloud> clouds;  ///< by body
    std::vector<BodyReport> reports;
};

/// Pass 1 of every body of a world, timed and counted: phases "points", "irradiance", "octree";
/// counts points, nodes, rays, nan; values spacingMm, meanFreePathMm (of the body with the finest
/// points) and bodies. Bodies in their diffuse limit get an empty cloud, and a warning if the scale
/// of the scene is likely to be wrong.
PassOne runPassOne(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                   const PreprocessLimits& limits, Reporter& reporter, RunStats& stats);

}  // namespace sss
