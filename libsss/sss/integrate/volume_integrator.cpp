#include "sss/integrate/volume_integrator.h"

#include "sss/base/error.h"
#include "sss/integrate/first_hit.h"
#include "sss/integrate/volume_path.h"

#include <fmt/core.h>

#include <algorithm>

namespace sss {
namespace {

[[noreturn]] void refuse(const World& world, const std::string& what, const std::string& hint) {
    throw Error(ErrorKind::BadInput, world.scene().file.string(), what, hint);
}

Ggx boundaryOf(const TranslucentMaterial& material) {
    return Ggx(static_cast<float>(material.roughness));
}

bool hasLightsWithoutSize(const World& world) {
    return std::ranges::any_of(world.lights(), [](const auto& light) { return light->isDelta(); });
}

void requireTraceable(const World& world, const Body& body) {
    const TranslucentMaterial& material = world.materialOf(body);
    if (!body.closed)
        refuse(world,
               fmt::format("the surface of \"{}\" is not closed, so that it has no inside for the "
                           "volume integrator",
                           body.name),
               "close the mesh, or take the integrator \"cached\"");
    if (material.medium.eta == 1.0 || !boundaryOf(material).isSpecular()) return;
    if (hasLightsWithoutSize(world))
        refuse(world,
               fmt::format("paths of the volume integrator that leave \"{}\" cannot find a point, "
                           "spot or directional light: the boundary is smooth, and it has no size",
                           body.name),
               "take a sphere, rectangle or environment light, or a \"roughness\" above 0.01, or "
               "set \"eta\" to 1");
}

}  // namespace

VolumeIntegrator::VolumeIntegrator(const IntegratorInput& input)
    : world_(input.world), optics_(input.optics) {
    for (const Body& body : world_.bodies()) {
        requireTraceable(world_, body);
        const TranslucentMaterial& material = world_.materialOf(body);
        const Medium& medium = material.medium;
        const DBounds bounds = body.mesh.bounds();
        media_.push_back({MediumCoefficients(medium), static_cast<float>(medium.eta),
                          boundaryOf(material), hasLightsWithoutSize(world_),
                          Vec3(body.worldFromBody.transformPoint(bounds.centre())),
                          static_cast<float>(0.5 * bounds.diagonal())});
    }
}

FilmSample VolumeIntegrator::trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const {
    FilmSample sample;
    ++counts.cameraSamples;
    Hit found;
    ++counts.rays;
    if (world_.rays().intersect(ray, found)) {
        const SurfaceHit hit = world_.surfaceAt(found);
        const BodyOptics* optics =
            hit.body >= 0 ? optics_[static_cast<std::size_t>(hit.body)].get() : nullptr;
        const Bsdf bsdf(world_, hit, -ray.direction, optics, Bsdf::BodyShading::Surface);
        describeFirstHit(world_, ray, hit, bsdf, sample);
    } else if (world_.hasVolumes()) {
        sample.alpha = 1 - meanComponent(world_.volumesAlong(ray, ray.tMax).transmittance());
    }
    VolumePath(world_, media_, sampler, counts).follow(ray, sample);
    return sample;
}

}  // namespace sss
