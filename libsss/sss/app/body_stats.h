#pragma once
#include "sss/app/run_stats.h"
#include "sss/integrate/preprocess.h"

#include <span>

namespace sss {

/// What pass 1 did for the bodies of a world, for --stats: counts points, nodes, rays, nan of those
/// that were `made`, not found in a cache (rays and nan by their reports); values spacingMm,
/// meanFreePathMm (of the body with the finest points) and bodies.
void recordBodies(std::span<const BodyReport> reports, std::span<const bool> made,
                  std::span<const std::unique_ptr<BodyOptics>> optics, RunStats& stats);

}  // namespace sss
