#include "receivers.h"

#include "sss/cloud/octree.h"
#include "sss/cloud/surface_strata.h"

#include <algorithm>
#include <cmath>

namespace sss::bench {
namespace {

Vec3 positionOn(const TriangleMesh& mesh, FaceIndex face, const Vec2& barycentrics) {
    const UVec3 f = mesh.faces[face];
    const DVec2 b(barycentrics);
    return Vec3(mesh.positions[f.x] * (1 - b.x - b.y) + mesh.positions[f.y] * b.x +
                mesh.positions[f.z] * b.y);
}

std::vector<Receiver> seenOnGrid(const Stage& stage, double step) {
    const World& world = stage.world();
    const FilmSettings& film = world.scene().film;
    std::vector<Receiver> seen;
    for (double y = 0.5 * step; y < film.height; y += step)
        for (double x = 0.5 * step; x < film.width; x += step) {
            const Vec2 pixel(std::floor(x) + 0.5, std::floor(y) + 0.5);
            Hit hit;
            if (!world.rays().intersect(world.camera().ray(pixel, Vec2(0.5f)), hit)) continue;
            const SurfaceHit surface = world.surfaceAt(hit);
            if (surface.body != 0) continue;
            seen.push_back({surface.bodyFace, surface.barycentrics,
                            positionOn(stage.body().mesh, surface.bodyFace, surface.barycentrics)});
        }
    return seen;
}

}  // namespace

std::vector<Receiver> receiversInView(const Stage& stage, std::size_t count) {
    // A coarse grid says which share of the film the body covers.
    const FilmSettings& film = stage.world().scene().film;
    const double coarse = std::max(1.0, film.height / 64.0);
    const auto covered = static_cast<double>(seenOnGrid(stage, coarse).size());
    const double step = coarse * std::sqrt(std::max(covered, 1.0) / static_cast<double>(count));
    return seenOnGrid(stage, step);
}

std::vector<Vec3> receiverGroups(const TriangleMesh& mesh, double meanFreePathMm,
                                 std::size_t count) {
    const double wanted = mesh.area() / (meanFreePathMm * meanFreePathMm);
    const std::size_t groups = std::max<std::size_t>(1, count / kGroup);
    const std::size_t all = std::max(groups, static_cast<std::size_t>(wanted) / kGroup);
    const SurfaceStrata strata = makeStrata(mesh, all * kGroup, 4);
    const std::vector<std::uint32_t> order = mortonOrder(strata.positions);
    std::vector<Vec3> receivers;
    for (std::size_t g = 0; g < groups; ++g) {
        const std::size_t first = g * all / groups * kGroup;
        for (std::size_t i = first; i < first + kGroup; ++i)
            receivers.push_back(strata.positions[order[i]]);
    }
    return receivers;
}

}  // namespace sss::bench
