#include "sss/cloud/surface_cells.h"

#include "sss/base/rng.h"
#include "sss/base/sampler.h"
#include "sss/geom/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace sss {
namespace {

struct Scattered {
    std::vector<Vec3> positions, normals;
};

// Random places of a mesh.
Scattered scatter(const TriangleMesh& mesh, int count, std::uint64_t seed) {
    Rng rng(seed);
    Scattered result;
    for (int i = 0; i < count; ++i) {
        const auto face = static_cast<FaceIndex>(rng.next64() % mesh.faceCount());
        const double x = std::sqrt(rng.uniformDouble()), y = rng.uniformDouble();
        result.positions.emplace_back(mesh.positionAt(face, {x * (1 - y), x * y}));
        result.normals.emplace_back(glm::normalize(mesh.faceCross(face)));
    }
    return result;
}

SurfaceCells cellsOf(const TriangleMesh& mesh, const Scattered& points) {
    const NearestPoints nearest(points.positions);
    SurfaceCells cells = makeSurfaceCells(mesh, {points.positions, points.normals, nearest});
    std::vector<std::uint32_t> same(points.positions.size());
    std::iota(same.begin(), same.end(), 0u);
    cells.groupByPoint(same, same.size());
    return cells;
}

// The rule itself, by trying all points.
std::uint32_t ownerOf(const DVec3& place, const DVec3& normal, const Scattered& points) {
    std::uint32_t best = 0;
    double least = 1e300;
    for (std::uint32_t p = 0; p < points.positions.size(); ++p) {
        const DVec3 d = DVec3(points.positions[p]) - place;
        if (glm::dot(DVec3(points.normals[p]), normal) > 0 && glm::dot(d, d) < least) {
            least = glm::dot(d, d);
            best = p;
        }
    }
    return best;
}

void expectVoronoi(const TriangleMesh& mesh, int pointCount) {
    const Scattered points = scatter(mesh, pointCount, 3);
    const SurfaceCells cells = cellsOf(mesh, points);
    std::vector<double> faceArea(mesh.faceCount(), 0.0);
    for (const CellPiece& piece : cells.pieces) {
        faceArea[piece.face] += piece.areaMm2;
        // Its middle belongs to it; so do its corners, drawn in a little.
        const DVec2 middle = centroidOf(piece, cells.corners);
        const DVec3 normal = mesh.faceCross(piece.face);
        ASSERT_EQ(ownerOf(mesh.positionAt(piece.face, middle), normal, points), piece.point);
        for (std::uint32_t k = 0; k < piece.cornerCount; ++k) {
            const DVec2 corner(cells.corners[piece.firstCorner + k]);
            const DVec3 place = mesh.positionAt(piece.face, glm::mix(corner, middle, 1e-3));
            ASSERT_EQ(ownerOf(place, normal, points), piece.point);
        }
    }
    for (FaceIndex f = 0; f < mesh.faceCount(); ++f)
        ASSERT_NEAR(faceArea[f] / mesh.faceArea(f), 1.0, 1e-12);
}

TEST(SurfaceCells, AreTheVoronoiCellsOfCoarseAndFineMeshes) {
    expectVoronoi(makeBox({3, 2, 1}), 500);       // many points a face
    expectVoronoi(makeBox({3, 2, 1}, 0.1), 200);  // many faces a point
    expectVoronoi(makeSphere(2), 300);
}

TEST(SurfaceCells, SidesOfASheetDoNotMix) { expectVoronoi(makeBox({3, 3, 0.001}), 400); }

TEST(SurfaceCells, SheetsCloseTogetherAreCutByTheirOwnPoints) {
    // Twelve sheets a thousandth apart, facing up and down: the nearest dozens of points lie on
    // others.
    TriangleMesh sheets;
    const TriangleMesh one = makeRectangle(2, 2);
    for (int k = 0; k < 12; ++k) {
        const auto first = static_cast<std::uint32_t>(sheets.positions.size());
        const DVec3 normal = glm::normalize(one.faceCross(0));
        for (const DVec3& p : one.positions) sheets.positions.push_back(p + normal * (k * 1e-3));
        for (const UVec3& f : one.faces)
            sheets.faces.push_back((k % 2 ? f : UVec3(f.x, f.z, f.y)) + UVec3(first));
    }
    expectVoronoi(sheets, 600);
}

TEST(SurfaceCells, AFaceThatNoPointFacesGoesToTheNearest) {
    const TriangleMesh mesh = makeRectangle(2, 2);
    Scattered points;
    points.positions = {{-0.5f, 0, 0}, {0.9f, 0, 0}};
    const Vec3 up(glm::normalize(mesh.faceCross(0)));
    points.normals = {-up, -up};
    const SurfaceCells cells = cellsOf(mesh, points);
    double area = 0;
    for (const CellPiece& piece : cells.pieces) area += piece.areaMm2;
    EXPECT_EQ(cells.pieces.size(), mesh.faceCount());
    EXPECT_NEAR(area, 4, 1e-12);
}

// Rounding, which differs from unit to unit, must not put corners where there are none: where
// places in a cell come to lie would hang on it.
TEST(SurfaceCells, AreTheSameInAnyUnit) {
    const DVec3 size(8, 9, 10);
    const TriangleMesh mesh = makeBox(size);
    const Scattered points = scatter(mesh, 300, 3);
    const SurfaceCells cells = cellsOf(mesh, points);
    for (const double unit : {1e-6, 1. / 3, 25.4, 1e6}) {
        Scattered scaled = points;
        for (Vec3& p : scaled.positions) p = Vec3(DVec3(p) * unit);
        const SurfaceCells other = cellsOf(makeBox(size * unit), scaled);
        ASSERT_EQ(other.pieces.size(), cells.pieces.size()) << unit;
        ASSERT_EQ(other.corners.size(), cells.corners.size()) << unit;
        for (std::size_t k = 0; k < cells.pieces.size(); ++k)
            ASSERT_EQ(other.pieces[k].cornerCount, cells.pieces[k].cornerCount) << unit;
        for (std::size_t k = 0; k < cells.corners.size(); ++k)
            EXPECT_LT(glm::length(other.corners[k] - cells.corners[k]), 1e-5f) << unit;
    }
}

TEST(SurfaceCells, PlacesInACellAreEvenlySpread) {
    const TriangleMesh mesh = makeBox({3, 2, 1}, 0.3);
    const Scattered points = scatter(mesh, 60, 9);
    const SurfaceCells cells = cellsOf(mesh, points);
    for (std::size_t p = 0; p < 60; p += 7) {
        constexpr std::uint32_t kPlaces = 4096;
        DVec3 mean{0}, centroid{0};
        double area = 0, size = 0;
        for (const CellPiece& piece : cells.piecesOf(p)) {
            const DVec3 c = mesh.positionAt(piece.face, centroidOf(piece, cells.corners));
            centroid += piece.areaMm2 * c;
            area += piece.areaMm2;
        }
        centroid /= area;
        for (std::uint32_t k = 0; k < kPlaces; ++k) {
            Sampler sampler(p, k);
            const SurfacePlace place = cells.placeIn(p, sampler.next2D());
            const DVec3 at = mesh.positionAt(place.face, DVec2(place.barycentrics));
            ASSERT_EQ(ownerOf(at, mesh.faceCross(place.face), points), p);
            mean += at / double{kPlaces};
            size = std::max(size, glm::length(at - centroid));
        }
        EXPECT_LT(glm::length(mean - centroid), 0.005 * size);
    }
}

}  // namespace
}  // namespace sss
