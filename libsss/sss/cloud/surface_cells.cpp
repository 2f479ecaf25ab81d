#include "sss/cloud/surface_cells.h"

#include "sss/base/parallel.h"
#include "sss/cloud/face_clipper.h"
#include "sss/cloud/face_order.h"

#include <algorithm>
#include <utility>

namespace sss {
namespace {

constexpr std::size_t kGrain = 512;  // faces

double cross(const DVec2& a, const DVec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

SurfacePlace SurfaceCells::placeIn(std::size_t point, const Vec2& u) const {
    const std::span<const CellPiece> all = piecesOf(point);
    double total = 0;
    for (const CellPiece& piece : all) total += piece.areaMm2;
    // The piece, then the triangle of its fan, that the first number falls on.
    double along = static_cast<double>(u.x) * total;
    std::size_t k = 0;
    while (k + 1 < all.size() && along >= all[k].areaMm2) along -= all[k++].areaMm2;
    const CellPiece& piece = all[k];
    const std::span<const Vec2> polygon =
        std::span(corners).subspan(piece.firstCorner, piece.cornerCount);
    const DVec2 a(polygon[0]);
    const auto fanArea = [&](std::size_t t) {
        return std::abs(cross(DVec2(polygon[t + 1]) - a, DVec2(polygon[t + 2]) - a));
    };
    double whole = 0;
    for (std::size_t t = 0; t + 2 < polygon.size(); ++t) whole += fanArea(t);
    along = std::clamp(along / piece.areaMm2, 0.0, 1.0) * whole;
    std::size_t t = 0;
    while (t + 3 < polygon.size() && along >= fanArea(t)) along -= fanArea(t++);
    const double area = fanArea(t);
    const double x = area > 0 ? std::min(along / area, 1.0) : 0.5;
    // Uniform in the triangle: the corner a keeps the share 1 - sqrt(x).
    const double root = std::sqrt(x), v = static_cast<double>(u.y);
    const DVec2 place = a * (1 - root) + DVec2(polygon[t + 1]) * (root * (1 - v)) +
                        DVec2(polygon[t + 2]) * (root * v);
    return {piece.face, Vec2(place)};
}

void SurfaceCells::groupByPoint(std::span<const std::uint32_t> newName, std::size_t pointCount) {
    firstPiece.assign(pointCount + 1, 0);
    for (const CellPiece& piece : pieces) ++firstPiece[newName[piece.point] + 1];
    for (std::size_t p = 0; p < pointCount; ++p) firstPiece[p + 1] += firstPiece[p];
    std::vector<std::uint32_t> next(firstPiece.begin(), firstPiece.end() - 1);
    std::vector<CellPiece> grouped(pieces.size());
    for (const CellPiece& piece : pieces) {
        CellPiece& slot = grouped[next[newName[piece.point]]++];
        slot = piece;
        slot.point = newName[piece.point];
    }
    pieces = std::move(grouped);
}

DVec2 centroidOf(const CellPiece& piece, std::span<const Vec2> corners) {
    const std::span<const Vec2> polygon = corners.subspan(piece.firstCorner, piece.cornerCount);
    const DVec2 a(polygon[0]);
    DVec2 sum(0), mean(0);
    double area = 0;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        const DVec2 b(polygon[k]), c(polygon[k + 1]);
        const double weight = std::abs(cross(b - a, c - a));
        area += weight;
        sum += weight * (a + b + c) / 3.0;
    }
    for (const Vec2& corner : polygon) mean += DVec2(corner);
    return area > 0 ? sum / area : mean / static_cast<double>(polygon.size());
}

SurfaceCells makeSurfaceCells(const TriangleMesh& mesh, const CellSeeds& seeds) {
    const NeighbourLists neighbours(seeds);
    const std::vector<FaceIndex> order = facesInSpaceOrder(mesh);
    std::vector<FacePieces> chunks((order.size() + kGrain - 1) / kGrain);
    parallelFor(order.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        FaceClipper clipper(mesh, seeds, neighbours);
        clipper.clip(std::span(order).subspan(begin, end - begin), chunks[begin / kGrain]);
    });
    SurfaceCells cells;
    for (const FacePieces& chunk : chunks) {
        const auto offset = static_cast<std::uint32_t>(cells.corners.size());
        for (CellPiece piece : chunk.pieces) {
            piece.firstCorner += offset;
            cells.pieces.push_back(piece);
        }
        cells.corners.insert(cells.corners.end(), chunk.corners.begin(), chunk.corners.end());
    }
    return cells;
}

}  // namespace sss
