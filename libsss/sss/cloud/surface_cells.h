#pragma once
#include "sss/base/vec.h"
#include "sss/cloud/nearest_points.h"
#include "sss/geom/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// A place on a mesh.
struct SurfacePlace {
    FaceIndex face = 0;
    Vec2 barycentrics{};  ///< of the second and third corner
};

/// The part of one face that belongs to one point: a convex polygon.
struct CellPiece {
    std::uint32_t point = 0;
    FaceIndex face = 0;
    std::uint32_t firstCorner = 0, cornerCount = 0;  ///< into SurfaceCells::corners
    double areaMm2 = 0;
};

/// The Voronoi cells of points on a surface: every place belongs to the nearest point that faces
/// the same way as its face (normals within 90 degrees), so that the two sides of a thin part do
/// not mix. The pieces of a face make up its area exactly.
struct SurfaceCells {
    std::vector<CellPiece> pieces;          ///< as made: by face; after groupByPoint: by point
    std::vector<Vec2> corners;              ///< barycentrics on the piece's face
    std::vector<std::uint32_t> firstPiece;  ///< per point, and one past the end

    std::span<const CellPiece> piecesOf(std::size_t point) const {
        return std::span(pieces).subspan(firstPiece[point],
                                         firstPiece[point + 1] - firstPiece[point]);
    }
    /// Maps the unit square to a cell so that equal areas get equal areas.
    SurfacePlace placeIn(std::size_t point, const Vec2& u) const;
    /// Renames the points (`newName[old]`) and sorts pieces by them, faces in their order.
    void groupByPoint(std::span<const std::uint32_t> newName, std::size_t pointCount);
};

/// Area centroid of a piece, in barycentrics of its face.
DVec2 centroidOf(const CellPiece& piece, std::span<const Vec2> corners);

/// Points as they are asked for their cells; all spans by point.
struct CellSeeds {
    std::span<const Vec3> positions, normals;
    const NearestPoints& nearest;  ///< of `positions`
};

/// Clips every face into the cells that reach it: from the cell at its middle to those across each
/// edge, until the face is used up. Each cell is cut by its neighbours in order of distance until
/// the next one is too far to matter [Levy & Liu 2010, "Lp centroidal Voronoi tessellation", radius
/// of security]. A face that none of the 64 points nearest its middle faces goes whole to the
/// nearest. Parallel; deterministic; about 2 us a piece.
SurfaceCells makeSurfaceCells(const TriangleMesh& mesh, const CellSeeds& seeds);

}  // namespace sss
