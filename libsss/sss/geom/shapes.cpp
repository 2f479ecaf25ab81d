#include "sss/geom/shapes.h"

#include "sss/geom/weld.h"

#include <algorithm>
#include <array>

namespace sss {

namespace {

// 20 x 80^2 = 128,000 triangles and 288 rim segments: the coarsest that keep 1e-4.
constexpr std::uint32_t kSphereFrequency = 80;
constexpr std::uint32_t kDiskRings = 48;

/// ceil(length / maxEdge) in [least, most].
std::uint32_t divisions(double length, double maxEdge, double least, double most) {
    return static_cast<std::uint32_t>(
        std::clamp(std::ceil(length / maxEdge), least, std::max(least, std::floor(most))));
}

std::vector<double> evenly(double size, std::uint32_t count) {
    std::vector<double> at(count + 1);
    for (std::uint32_t i = 0; i <= count; ++i)
        at[i] = size * ((static_cast<double>(i) - 0.5 * count) / count);
    return at;
}

std::uint32_t vertexCount(const TriangleMesh& mesh) {
    return static_cast<std::uint32_t>(mesh.positions.size());
}

/// Triangles of a grid of `columns` x `rows` vertices that starts at vertex `base`.
void addGridFaces(TriangleMesh& mesh, std::uint32_t base, std::uint32_t columns,
                  std::uint32_t rows) {
    for (std::uint32_t r = 0; r + 1 < rows; ++r)
        for (std::uint32_t c = 0; c + 1 < columns; ++c) {
            const std::uint32_t a = base + r * columns + c, b = a + columns;
            mesh.faces.emplace_back(a, a + 1, b + 1);
            mesh.faces.emplace_back(a, b + 1, b);
        }
}

/// A plane grid over `us` x `vs` on the axes u and v of a right-handed (u, v, w), at w.
struct GridAxes {
    int u, v, w;
    double side;  ///< +1 or -1: which way the grid faces along w
};
void addPlane(TriangleMesh& mesh, const GridAxes& axes, const std::vector<double>& us,
              const std::vector<double>& vs, double w) {
    const std::uint32_t base = vertexCount(mesh);
    Vec3 normal{0.0f};
    normal[axes.w] = static_cast<float>(axes.side);
    for (double v : vs)
        for (std::size_t i = 0; i < us.size(); ++i) {
            // Seen from the back a grid runs the other way round.
            const double u = axes.side > 0 ? us[i] : us[us.size() - 1 - i];
            DVec3 p;
            p[axes.u] = u;
            p[axes.v] = v;
            p[axes.w] = w;
            mesh.positions.push_back(p);
            mesh.normals.push_back(normal);
        }
    addGridFaces(mesh, base, static_cast<std::uint32_t>(us.size()),
                 static_cast<std::uint32_t>(vs.size()));
}

/// Point `index` of `count` on a circle in (x, y); the same bits wherever it is used.
DVec2 circlePoint(double radius, std::uint32_t index, std::uint32_t count) {
    const double angle = 2.0 * kPi * (index % count) / count;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Concentric rings of 6, 12, 18, ... vertices in (x, y), facing +z.
TriangleMesh diskOfRings(double radius, std::uint32_t rings) {
    TriangleMesh mesh;
    mesh.positions.emplace_back(0);
    for (std::uint32_t ring = 1; ring <= rings; ++ring)
        for (std::uint32_t i = 0; i < 6 * ring; ++i)
            mesh.positions.emplace_back(circlePoint(radius * ring / rings, i, 6 * ring), 0.0);
    const auto vertex = [](std::uint32_t ring, std::uint32_t i) {
        return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + i % (6 * ring);
    };
    for (std::uint32_t ring = 1; ring <= rings; ++ring)
        for (std::uint32_t sector = 0; sector < 6; ++sector)
            for (std::uint32_t i = 0; i < ring; ++i) {
                const std::uint32_t outer = sector * ring + i, inner = sector * (ring - 1) + i;
                mesh.faces.emplace_back(vertex(ring - 1, inner), vertex(ring, outer),
                                        vertex(ring, outer + 1));
                if (i + 1 < ring)
                    mesh.faces.emplace_back(vertex(ring - 1, inner), vertex(ring, outer + 1),
                                            vertex(ring - 1, inner + 1));
            }
    mesh.normals.assign(mesh.positions.size(), Vec3{0, 0, 1});
    return mesh;
}

/// Rings whose triangles have no edge above maxEdge: the longest goes one ring outward, 1/rings,
/// and up to one step along it, (2 pi / 6) / rings.
std::uint32_t ringCount(double radius, double maxEdge, double triangleBudget) {
    return divisions(std::hypot(1.0, kPi / 3.0) * radius, maxEdge, kDiskRings,
                     std::sqrt(triangleBudget / 6));
}

/// Merges vertices at the same position; for meshes whose normals follow from positions.
void mergeCoincident(TriangleMesh& mesh) {
    const std::vector<std::uint32_t> first = weldPositions(mesh.positions);
    std::vector<std::uint32_t> index(first.size());
    std::vector<DVec3> kept;
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (first[i] == i) {
            index[i] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(mesh.positions[i]);
        } else {
            index[i] = index[first[i]];
        }
    }
    for (UVec3& f : mesh.faces) f = {index[f.x], index[f.y], index[f.z]};
    mesh.positions = std::move(kept);
}

constexpr double kGolden = 1.6180339887498948482;
constexpr std::array<DVec3, 12> kIcosahedron{{{-1, kGolden, 0},
                                              {1, kGolden, 0},
                                              {-1, -kGolden, 0},
                                              {1, -kGolden, 0},
                                              {0, -1, kGolden},
                                              {0, 1, kGolden},
                                              {0, -1, -kGolden},
                                              {0, 1, -kGolden},
                                              {kGolden, 0, -1},
                                              {kGolden, 0, 1},
                                              {-kGolden, 0, -1},
                                              {-kGolden, 0, 1}}};
constexpr std::array<std::array<std::uint32_t, 3>, 20> kIcosahedronFaces{
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

/// i a + j b + k c for the corners of an icosahedron's face, summed in the order of the corners'
/// numbers, so that two faces get the same bits on their common edge.
DVec3 weightedCorners(const std::array<std::uint32_t, 3>& face,
                      const std::array<std::uint32_t, 3>& weights) {
    std::array<std::pair<std::uint32_t, std::uint32_t>, 3> terms;
    for (std::size_t c = 0; c < 3; ++c) terms[c] = {face[c], weights[c]};
    std::sort(terms.begin(), terms.end());
    DVec3 sum{0};
    for (const auto& [corner, weight] : terms)
        sum += kIcosahedron[corner] * static_cast<double>(weight);
    return sum;
}

}  // namespace

TriangleMesh makeSphere(double radius, double maxEdge) {
    // The longest edges lie in the middle of the icosahedron's faces, where the projection scales
    // its edge, 1.0515, by the inverse of the inner radius 0.7947.
    const std::uint32_t n =
        divisions(1.3232 * radius, maxEdge, kSphereFrequency, std::sqrt(kMaxShapeTriangles / 20.0));
    TriangleMesh mesh;
    mesh.faces.reserve(20ull * n * n);
    for (const auto& face : kIcosahedronFaces) {
        const std::uint32_t base = vertexCount(mesh);
        const auto vertex = [&](std::uint32_t row, std::uint32_t i) {
            return base + row * (row + 1) / 2 + i;
        };
        for (std::uint32_t row = 0; row <= n; ++row)
            for (std::uint32_t i = 0; i <= row; ++i)
                mesh.positions.push_back(
                    radius * glm::normalize(weightedCorners(face, {n - row, row - i, i})));
        for (std::uint32_t row = 0; row < n; ++row)
            for (std::uint32_t i = 0; i <= row; ++i) {
                mesh.faces.emplace_back(vertex(row, i), vertex(row + 1, i), vertex(row + 1, i + 1));
                if (i < row)
                    mesh.faces.emplace_back(vertex(row, i), vertex(row + 1, i + 1),
                                            vertex(row, i + 1));
            }
    }
    mergeCoincident(mesh);
    mesh.normals.reserve(mesh.positions.size());
    for (const DVec3& p : mesh.positions) mesh.normals.emplace_back(p / radius);
    return mesh;
}

TriangleMesh makeRectangle(double width, double height, double maxEdge) {
    // The diagonal of a cell is its longest edge.
    const double cell =
        std::max(maxEdge / std::sqrt(2.0), std::sqrt(2.0 * width * height / kMaxShapeTriangles));
    TriangleMesh mesh;
    addPlane(mesh, {0, 1, 2, 1.0}, evenly(width, divisions(width, cell, 1, 1e6)),
             evenly(height, divisions(height, cell, 1, 1e6)), 0.0);
    return mesh;
}

TriangleMesh makeDisk(double radius, double maxEdge) {
    return diskOfRings(radius, ringCount(radius, maxEdge, kMaxShapeTriangles));
}

TriangleMesh makeBox(const DVec3& size, double maxEdge) {
    const double faceArea = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const double cell =
        std::max(maxEdge / std::sqrt(2.0), std::sqrt(2.0 * faceArea / kMaxShapeTriangles));
    std::array<std::vector<double>, 3> at;
    for (int axis = 0; axis < 3; ++axis)
        at[static_cast<std::size_t>(axis)] =
            evenly(size[axis], divisions(size[axis], cell, 1, 1e6));
    TriangleMesh mesh;
    for (int w = 0; w < 3; ++w) {
        const int u = (w + 1) % 3, v = (w + 2) % 3;
        const auto& us = at[static_cast<std::size_t>(u)];
        const auto& vs = at[static_cast<std::size_t>(v)];
        const auto& ws = at[static_cast<std::size_t>(w)];
        addPlane(mesh, {u, v, w, 1.0}, us, vs, ws.back());
        addPlane(mesh, {u, v, w, -1.0}, us, vs, ws.front());
    }
    return mesh;
}

TriangleMesh makeCylinder(double radius, double height, double maxEdge) {
    constexpr double kCapBudget = 0.4 * kMaxShapeTriangles;  // both caps; the side takes the rest
    const std::uint32_t rings = ringCount(radius, maxEdge, kCapBudget / 2);
    const std::uint32_t segments = 6 * rings;
    // A side cell's diagonal is its longest edge; cells are square unless maxEdge is shorter. (The
    // rim is at most 0.73 maxEdge wide by the caps' rule, so the root is real, but for the cap.)
    const double rimEdge = 2.0 * kPi * radius / segments;
    const double tall = std::sqrt(std::max(maxEdge * maxEdge - rimEdge * rimEdge, 1e-300));
    const std::uint32_t rows = divisions(height, std::min(rimEdge, tall), 1,
                                         (kMaxShapeTriangles - kCapBudget) / (2.0 * segments));
    const std::vector<double> ys = evenly(height, rows);
    TriangleMesh mesh;
    for (double y : ys)
        for (std::uint32_t i = 0; i <= segments; ++i) {
            const DVec2 c = circlePoint(radius, i, segments);
            mesh.positions.emplace_back(c.x, y, -c.y);  // counter-clockwise seen from +y
            mesh.normals.emplace_back(DVec3(c.x, 0.0, -c.y) / radius);
        }
    addGridFaces(mesh, 0, segments + 1, rows + 1);
    const TriangleMesh disk = diskOfRings(radius, rings);
    for (const double side : {1.0, -1.0}) {
        const std::uint32_t base = vertexCount(mesh);
        for (const DVec3& p : disk.positions) {
            mesh.positions.emplace_back(p.x, side > 0 ? ys.back() : ys.front(), -p.y);
            mesh.normals.emplace_back(0.0f, static_cast<float>(side), 0.0f);
        }
        for (const UVec3& f : disk.faces)
            mesh.faces.push_back(UVec3{base} + (side > 0 ? f : UVec3{f.x, f.z, f.y}));
    }
    return mesh;
}

}  // namespace sss
