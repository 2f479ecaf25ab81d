#pragma once
#include "sss/cloud/point_cloud.h"
#include "sss/cloud/surface_cells.h"

#include <cstdint>
#include <vector>

namespace sss {

/// Points that stand for a surface: a blue-noise set, in Morton order, and their cells.
struct SurfaceSamples {
    std::vector<SurfacePoint> points;
    SurfaceCells cells;
    bool inMortonOrder = true;  ///< false once carried to another shape

    std::size_t size() const { return points.size(); }
};

struct SamplerOptions {
    double spacingMm = 1;  ///< asked-for sqrt(area / points)
    std::uint64_t seed = 0;
    std::size_t candidatesPerPoint = 6;
    std::size_t fewestPoints = 256;  ///< on a body smaller than the spacing
};

/// How many points a surface will get; for estimates and limits before any memory is taken.
std::size_t expectedPointCount(double areaMm2, const SamplerOptions& options);

/// Places points on `mesh` (body space, mm, no degenerate faces): a maximal Poisson-disk set of
/// stratified candidates; a point lies at the centroid of its Voronoi cell on the surface (see
/// makeSurfaceCells) and has exactly the cell's area, so that the areas sum to the area of the
/// mesh. A function of (mesh, options) only: never of camera, lights or frame. Near-linear;
/// parallel; deterministic.
///
/// Why centroids and areas of cells: with them the sum over points is a quadrature rule that is
/// exact for linear functions on each cell; equal weights need 5x the points for the same error.
SurfaceSamples sampleSurface(const TriangleMesh& mesh, const SamplerOptions& options);

/// The same points on another shape of the same faces: every cell is made of the same parts of the
/// same faces as on `from`, in the same order; centroid, area and normal follow the shape `to`.
SurfaceSamples carrySamples(SurfaceSamples samples, const TriangleMesh& from,
                            const TriangleMesh& to);

}  // namespace sss
