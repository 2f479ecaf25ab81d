#include "sss/cloud/surface_sampler.h"

#include "sss/base/parallel.h"
#include "sss/base/rng.h"
#include "sss/cloud/dart_throwing.h"
#include "sss/cloud/nearest_points.h"
#include "sss/cloud/octree.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

// A maximal Poisson-disk set of radius r out of kStrata candidates a point has spacing
// sqrt(area / points) = kSpacingOverRadius r (measured on planes and on the bunny).
constexpr double kSpacingOverRadius = 1.30;
constexpr std::size_t kGrain = 4096;

std::vector<Vec3> stratumNormals(const TriangleMesh& mesh, const SurfaceStrata& strata) {
    std::vector<Vec3> normals(strata.size());
    parallelFor(strata.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            normals[i] = Vec3(glm::normalize(mesh.faceCross(strata.faces[i])));
    });
    return normals;
}

// The chosen point that each stratum belongs to: the nearest one facing the same way, or, where
// none of the nearest does, the one that covered it in dart throwing.
std::vector<std::uint32_t> assignOwners(const SurfaceStrata& strata, std::span<const Vec3> normals,
                                        std::span<const std::uint32_t> chosen,
                                        std::span<const std::uint32_t> fallback) {
    std::vector<Vec3> positions(chosen.size());
    for (std::size_t p = 0; p < chosen.size(); ++p) positions[p] = strata.positions[chosen[p]];
    const NearestPoints nearest(positions);
    std::vector<std::uint32_t> owner(strata.size());
    parallelFor(strata.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<NearestPoints::Neighbours> near(end - begin);
        nearest.query(std::span(strata.positions).subspan(begin, end - begin), near);
        for (std::size_t i = begin; i < end; ++i) {
            const NearestPoints::Neighbours& n = near[i - begin];
            owner[i] = fallback[i];
            for (int j = 0; j < n.count; ++j) {
                if (glm::dot(normals[chosen[n.index[j]]], normals[i]) > 0.0f) {
                    owner[i] = n.index[j];
                    break;
                }
            }
        }
    });
    return owner;
}

// Reorders strata so that those of point 0 come first, then those of point 1, ...
void groupByOwner(SurfaceSamples& samples, std::span<const std::uint32_t> owner,
                  std::size_t pointCount, std::vector<Vec3>& normals) {
    samples.firstStratum.assign(pointCount + 1, 0);
    for (const std::uint32_t o : owner) ++samples.firstStratum[o + 1];
    for (std::size_t p = 0; p < pointCount; ++p)
        samples.firstStratum[p + 1] += samples.firstStratum[p];
    std::vector<std::uint32_t> next(samples.firstStratum.begin(), samples.firstStratum.end() - 1);
    SurfaceStrata grouped;
    grouped.areaMm2 = samples.strata.areaMm2;
    grouped.positions.resize(owner.size());
    grouped.faces.resize(owner.size());
    grouped.barycentrics.resize(owner.size());
    std::vector<Vec3> groupedNormals(owner.size());
    for (std::size_t i = 0; i < owner.size(); ++i) {
        const std::uint32_t slot = next[owner[i]]++;
        grouped.positions[slot] = samples.strata.positions[i];
        grouped.faces[slot] = samples.strata.faces[i];
        grouped.barycentrics[slot] = samples.strata.barycentrics[i];
        groupedNormals[slot] = normals[i];
    }
    samples.strata = std::move(grouped);
    normals = std::move(groupedNormals);
}

std::uint16_t quantise(float x) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(x, 0.0f, 1.0f) * 65535.0f));
}

SurfacePoint summariseCell(const SurfaceStrata& strata, std::span<const Vec3> normals,
                           std::uint32_t begin, std::uint32_t end) {
    DVec3 centroid{0}, normal{0};
    for (std::uint32_t s = begin; s < end; ++s) {
        centroid += DVec3(strata.positions[s]);
        normal += DVec3(normals[s]);
    }
    const auto count = static_cast<double>(end - begin);
    SurfacePoint point;
    point.position = Vec3(centroid / count);
    point.areaMm2 = static_cast<float>(count * strata.areaMm2);
    const double length = glm::length(normal);
    point.normal = encodeUnitVector(length > 1e-9 ? Vec3(normal / length) : normals[begin]);
    std::uint32_t anchor = begin;
    float best = std::numeric_limits<float>::max();
    for (std::uint32_t s = begin; s < end; ++s) {
        const Vec3 d = strata.positions[s] - point.position;
        if (glm::dot(d, d) < best) {
            best = glm::dot(d, d);
            anchor = s;
        }
    }
    point.face = strata.faces[anchor];
    point.u = quantise(strata.barycentrics[anchor].x);
    // Both may round up: never beyond the edge opposite the first corner.
    point.v = std::min(quantise(strata.barycentrics[anchor].y),
                       static_cast<std::uint16_t>(65535 - point.u));
    return point;
}

}  // namespace

std::size_t expectedPointCount(double areaMm2, const SamplerOptions& options) {
    const double wanted = areaMm2 / (options.spacingMm * options.spacingMm);
    return std::max(options.fewestPoints, static_cast<std::size_t>(std::ceil(std::min(wanted, 1e18))));
}

SurfaceSamples sampleSurface(const TriangleMesh& mesh, const SamplerOptions& options) {
    const double area = mesh.area();
    const std::size_t wanted = expectedPointCount(area, options);
    const double radius = std::sqrt(area / static_cast<double>(wanted)) / kSpacingOverRadius;

    SurfaceSamples samples;
    samples.strata = makeStrata(mesh, wanted * options.strataPerPoint, options.seed);
    std::vector<Vec3> normals = stratumNormals(mesh, samples.strata);
    const DartThrow darts =
        throwDarts(samples.strata.positions, normals, radius, combineSeeds(options.seed, 1));

    // Points in Morton order of the darts: near enough to that of the centroids for locality, but
    // the octree wants the exact order, so that is made at the end.
    std::vector<std::uint32_t> rank(samples.strata.size(), 0);
    for (std::uint32_t p = 0; p < darts.chosen.size(); ++p) rank[darts.chosen[p]] = p;
    std::vector<std::uint32_t> fallback(samples.strata.size());
    for (std::size_t i = 0; i < fallback.size(); ++i) fallback[i] = rank[darts.blocker[i]];
    std::vector<std::uint32_t> owner =
        assignOwners(samples.strata, normals, darts.chosen, fallback);

    // Centroids first, in dart order; then the order of the octree, then the strata in that order.
    std::vector<DVec3> sums(darts.chosen.size(), DVec3(0));
    std::vector<std::uint32_t> counts(darts.chosen.size(), 0);
    for (std::size_t i = 0; i < owner.size(); ++i) {
        sums[owner[i]] += DVec3(samples.strata.positions[i]);
        ++counts[owner[i]];
    }
    std::vector<Vec3> centroids(sums.size());
    for (std::size_t p = 0; p < sums.size(); ++p)
        centroids[p] = counts[p] ? Vec3(sums[p] / static_cast<double>(counts[p]))
                                 : samples.strata.positions[darts.chosen[p]];
    std::vector<std::uint32_t> order = mortonOrder(centroids);
    std::erase_if(order, [&](std::uint32_t p) { return counts[p] == 0; });
    std::vector<std::uint32_t> position(sums.size(), 0);
    for (std::uint32_t k = 0; k < order.size(); ++k) position[order[k]] = k;
    for (std::uint32_t& o : owner) o = position[o];
    groupByOwner(samples, owner, order.size(), normals);

    samples.points.resize(order.size());
    parallelFor(order.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            samples.points[p] = summariseCell(samples.strata, normals, samples.firstStratum[p],
                                              samples.firstStratum[p + 1]);
    });
    return samples;
}

}  // namespace sss
