#include "sss/integrate/diffuse_limit.h"

#include "sss/base/distribution.h"
#include "sss/base/sampler.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

constexpr std::uint32_t kPlaces = 1024;
constexpr std::size_t kLeftOut = kPlaces / 1000;  // the thinnest places

// Distance to the body's own surface along a ray; infinite if there is none.
float distanceToSelf(const World& world, int body, const Vec3& from, const Vec3& direction) {
    Ray ray;
    ray.origin = from;
    ray.direction = direction;
    Hit hit;
    return world.rays().intersect(ray, hit, bodyMask(body))
               ? hit.t
               : std::numeric_limits<float>::infinity();
}

Bounds boundsInWorld(const Body& body) {
    Bounds bounds;
    for (const DVec3& p : body.mesh.positions)
        bounds.add(Vec3(body.worldFromBody.transformPoint(p)));
    return bounds;
}

// A filter narrower than a pixel shows finer things.
double filterWidthPixels(const FilmSettings& film) {
    return film.filterRadiusPixels > 0 ? std::min(1.0, 2 * film.filterRadiusPixels) : 1.0;
}

// Of the channels that send anything out.
double longestMeanFreePath(const BodyOptics& optics) {
    double longest = 0;
    for (int c = 0; c < 3; ++c)
        if (optics.diffuseAlbedo[c] > 0)
            longest = std::max(longest, optics.material.medium.channel(c).meanFreePathMm());
    return longest;
}

double longestMeanShift(const BodyOptics& optics, double reachMm) {
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c)
        if (optics.firstLike(static_cast<int>(c)) == static_cast<int>(c))
            longest = std::max(longest, meanShiftMm(*optics.profiles[c], reachMm));
    return longest;
}

}  // namespace

double meanShiftMm(const Profile& profile, double reachMm) {
    const double total = profile.total();
    if (!(total > 0) || !(reachMm > 0)) return 0;
    // Below the first step next to nothing has left.
    constexpr int kSteps = 256;
    const double lo = std::log(std::min(1e-4 * profile.scaleMm(), 1e-4 * reachMm));
    const double step = (std::log(reachMm) - lo) / kSteps;
    double sum = std::exp(lo) * total;
    for (int i = 0; i < kSteps; ++i) {
        const double r = std::exp(lo + (i + 0.5) * step);
        sum += r * profile.tail(r) * step;
    }
    return sum / total;
}

double localThicknessMm(const World& world, int bodyIndex) {
    const Body& body = world.bodies()[static_cast<std::size_t>(bodyIndex)];
    std::vector<double> areas(body.mesh.faceCount());
    for (std::size_t f = 0; f < areas.size(); ++f)
        areas[f] = body.mesh.faceArea(static_cast<FaceIndex>(f));
    const PiecewiseConstant1D byArea(areas);
    std::vector<float> distances;
    for (std::uint32_t k = 0; k < kPlaces; ++k) {
        Sampler sampler(0x7417c4ull, k);
        const auto face = static_cast<FaceIndex>(byArea.sample(sampler.next1D()).cell);
        Vec2 place = sampler.next2D();
        if (place.x + place.y > 1) place = Vec2(1) - place;
        const SurfaceHit hit = world.surfaceOf(bodyIndex, face, place);
        const Vec3& n = hit.geometricNormal;
        distances.push_back(std::min(distanceToSelf(world, bodyIndex, World::leave(hit, n), n),
                                     distanceToSelf(world, bodyIndex, World::leave(hit, -n), -n)));
    }
    const auto thinnest = distances.begin() + kLeftOut;
    std::nth_element(distances.begin(), thinnest, distances.end());
    return std::min(static_cast<double>(*thinnest),
                    static_cast<double>(body.mesh.bounds().diagonal()));
}

void findDiffuseLimits(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                       Reporter& reporter) {
    const Scene& scene = world.scene();
    for (std::size_t b = 0; b < optics.size(); ++b) {
        const Body& body = world.bodies()[b];
        const double pixel =
            world.camera().pixelWidthMm(boundsInWorld(body)) * filterWidthPixels(scene.film);
        // The cheapest question first: most bodies are far from their limit.
        const double allowed = scene.quality.tolerance * pixel;
        if (longestMeanFreePath(*optics[b]) > allowed) continue;
        const double shift = longestMeanShift(*optics[b], body.mesh.bounds().diagonal());
        if (shift > allowed) continue;
        const double thickness = localThicknessMm(world, static_cast<int>(b));
        if (shift > scene.quality.tolerance * thickness) continue;
        optics[b]->inDiffuseLimit = true;
        reporter.info("points",
                      fmt::format("{}: none needed: light leaves {:.2g} mm from where it entered, "
                                  "a pixel is {:.2g} mm wide there, and the body {:.2g} mm thick",
                                  body.name, shift, pixel, thickness));
    }
}

}  // namespace sss
