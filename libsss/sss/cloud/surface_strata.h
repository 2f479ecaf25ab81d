#pragma once
#include "sss/base/vec.h"
#include "sss/geom/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace sss {

/// A stratified, uniform sampling of a surface by area: the candidates among which points are
/// chosen.
struct SurfaceStrata {
    std::vector<Vec3> positions;  ///< mm, in the mesh's space
    std::vector<FaceIndex> faces;
    std::vector<Vec2> barycentrics;  ///< of the second and third corner
    double areaMm2 = 0;              ///< of each stratum

    std::size_t size() const { return positions.size(); }
};

/// `count` strata of `mesh`: stratum i lies at (i + start) / count along the faces' cumulative
/// area, the faces in Z-order, so that strata are spread evenly whether they are smaller than the
/// faces or larger; within a face, along a Hammersley set. A function of (mesh, count, seed) only.
SurfaceStrata makeStrata(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed);

}  // namespace sss
