#pragma once
#include "sss/base/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Chooses a maximal Poisson-disk subset of candidates: no two chosen ones that face the same way
/// (normals within 90 degrees) are nearer than `radiusMm`, and every candidate that was not chosen
/// has a chosen one nearer than that, which faces the same way. Opposite faces of thin parts are
/// sampled each on its own.
///
/// Parallel dart throwing on a grid in 27 phases, after [Bowers et al. 2010]; the result depends on
/// the candidates and the seed only. Near-linear: about 0.3 us a candidate.
struct DartThrow {
    std::vector<std::uint32_t> chosen;  ///< ascending candidate indices
    std::vector<std::uint32_t>
        blocker;  ///< per candidate: the chosen one that covers it (itself if chosen)
};
DartThrow throwDarts(std::span<const Vec3> positions, std::span<const Vec3> normals,
                     double radiusMm, std::uint64_t seed);

}  // namespace sss
