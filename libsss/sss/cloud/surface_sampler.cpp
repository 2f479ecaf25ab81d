#include "sss/cloud/surface_sampler.h"

#include "sss/base/parallel.h"
#include "sss/base/rng.h"
#include "sss/cloud/dart_throwing.h"
#include "sss/cloud/octree.h"
#include "sss/cloud/surface_strata.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

// A maximal Poisson-disk set of radius r out of candidatesPerPoint candidates a point has spacing
// sqrt(area / points) = kSpacingOverRadius r (measured on planes and on the bunny).
constexpr double kSpacingOverRadius = 1.342;

struct Darts {
    std::vector<Vec3> positions, normals;
};

Darts chooseDarts(const TriangleMesh& mesh, std::size_t wanted, const SamplerOptions& options) {
    const double radius = std::sqrt(mesh.area() / static_cast<double>(wanted)) / kSpacingOverRadius;
    const SurfaceStrata candidates =
        makeStrata(mesh, wanted * options.candidatesPerPoint, options.seed);
    std::vector<Vec3> normals(candidates.size());
    parallelFor(candidates.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            normals[i] = Vec3(glm::normalize(mesh.faceCross(candidates.faces[i])));
    });
    const DartThrow thrown =
        throwDarts(candidates.positions, normals, radius, combineSeeds(options.seed, 1));
    Darts darts;
    darts.positions.reserve(thrown.chosen.size());
    darts.normals.reserve(thrown.chosen.size());
    for (const std::uint32_t i : thrown.chosen) {
        darts.positions.push_back(candidates.positions[i]);
        darts.normals.push_back(normals[i]);
    }
    return darts;
}

std::uint16_t quantise(double x) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(x, 0.0, 1.0) * 65535.0));
}

// Centroids of all cells, in the order of the darts; a dart whose cell has vanished gets area 0.
struct CellSum {
    DVec3 position{0};
    double areaMm2 = 0;
};

std::vector<CellSum> sumCells(const TriangleMesh& mesh, const SurfaceCells& cells,
                              std::size_t count) {
    std::vector<CellSum> sums(count);
    for (const CellPiece& piece : cells.pieces) {
        CellSum& sum = sums[piece.point];
        sum.position +=
            piece.areaMm2 * mesh.positionAt(piece.face, centroidOf(piece, cells.corners));
        sum.areaMm2 += piece.areaMm2;
    }
    return sums;
}

SurfacePoint makePoint(const TriangleMesh& mesh, const SurfaceCells& cells, std::size_t index) {
    DVec3 sum{0}, normal{0};
    double area = 0;
    const std::span<const CellPiece> pieces = cells.piecesOf(index);
    for (const CellPiece& piece : pieces) {
        sum += piece.areaMm2 * mesh.positionAt(piece.face, centroidOf(piece, cells.corners));
        area += piece.areaMm2;
        normal += piece.areaMm2 * glm::normalize(mesh.faceCross(piece.face));
    }
    const DVec3 centroid = sum / area;
    SurfacePoint point;
    point.position = Vec3(centroid);
    point.areaMm2 = static_cast<float>(area);
    const double length = glm::length(normal);
    point.normal = encodeUnitVector(Vec3(
        length > 1e-9 * area ? normal / length : glm::normalize(mesh.faceCross(pieces[0].face))));
    // The anchor: the middle of the piece nearest the centroid.
    double best = std::numeric_limits<double>::max();
    for (const CellPiece& piece : pieces) {
        const DVec2 b = centroidOf(piece, cells.corners);
        const DVec3 d = mesh.positionAt(piece.face, b) - centroid;
        if (glm::dot(d, d) >= best) continue;
        best = glm::dot(d, d);
        point.face = piece.face;
        point.u = quantise(b.x);
        // Both may round up: never beyond the edge opposite the first corner.
        point.v = std::min(quantise(b.y), static_cast<std::uint16_t>(65535 - point.u));
    }
    return point;
}

}  // namespace

std::size_t expectedPointCount(double areaMm2, const SamplerOptions& options) {
    const double wanted = areaMm2 / (options.spacingMm * options.spacingMm);
    return std::max(options.fewestPoints,
                    static_cast<std::size_t>(std::ceil(std::min(wanted, 1e18))));
}

SurfaceSamples sampleSurface(const TriangleMesh& mesh, const SamplerOptions& options) {
    const Darts darts = chooseDarts(mesh, expectedPointCount(mesh.area(), options), options);
    SurfaceSamples samples;
    const NearestPoints nearest(darts.positions);
    samples.cells = makeSurfaceCells(mesh, {darts.positions, darts.normals, nearest});

    // Points in the order of the octree; a cell that rounding has swallowed has none.
    const std::vector<CellSum> sums = sumCells(mesh, samples.cells, darts.positions.size());
    std::vector<Vec3> centroids;
    std::vector<std::uint32_t> dartOf;
    for (std::uint32_t d = 0; d < sums.size(); ++d)
        if (sums[d].areaMm2 > 0) {
            centroids.emplace_back(sums[d].position / sums[d].areaMm2);
            dartOf.push_back(d);
        }
    const std::vector<std::uint32_t> order = mortonOrder(centroids);
    std::vector<std::uint32_t> pointOf(sums.size(), 0);
    for (std::uint32_t k = 0; k < order.size(); ++k) pointOf[dartOf[order[k]]] = k;
    samples.cells.groupByPoint(pointOf, order.size());
    samples.points.resize(order.size());
    parallelFor(order.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            samples.points[p] = makePoint(mesh, samples.cells, p);
    });
    return samples;
}

SurfaceSamples carrySamples(SurfaceSamples samples, const TriangleMesh& from,
                            const TriangleMesh& to) {
    for (CellPiece& piece : samples.cells.pieces)
        piece.areaMm2 *=
            glm::length(to.faceCross(piece.face)) / glm::length(from.faceCross(piece.face));
    parallelFor(samples.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            samples.points[p] = makePoint(to, samples.cells, p);
    });
    samples.inMortonOrder = false;
    return samples;
}

}  // namespace sss
