#pragma once
#include "sss/base/vec.h"
#include "sss/geom/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace sss {

/// A fine, stratified, uniform sampling of a surface by area: every stratum stands for the same
/// share of it. Points are chosen among strata, and what a point stands for (its area, its
/// irradiance) is summed over the strata nearest to it.
struct SurfaceStrata {
    std::vector<Vec3> positions;  ///< mm, in the mesh's space
    std::vector<FaceIndex> faces;
    std::vector<Vec2> barycentrics;  ///< of the second and third corner
    double areaMm2 = 0;              ///< of each stratum

    std::size_t size() const { return positions.size(); }
};

/// One of several sets of strata that lie between one another's.
struct StrataPart {
    std::uint32_t index = 0, of = 1;
};

/// `count` strata of `mesh`: stratum i lies at (i + start) / count along the faces' cumulative
/// area, the faces in Z-order, so that strata are spread evenly whether they are smaller than the
/// faces or larger; within a face, along a Hammersley set. All `part.of` parts together are as even
/// as one set of part.of x count. A function of (mesh, count, seed, part) only.
SurfaceStrata makeStrata(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed,
                         const StrataPart& part = {});

}  // namespace sss
