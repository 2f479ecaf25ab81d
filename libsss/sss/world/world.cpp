#include "sss/world/world.h"

#include "sss/base/error.h"
#include "sss/base/require_memory.h"
#include "sss/light/light_table.h"
#include "sss/medium/measured_media.h"
#include "sss/world/nested_shells.h"
#include "sss/world/volume_loader.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace sss {

std::uint32_t bodyMask(int body) { return 2u << (body % 31); }

namespace {

// What a triangle takes when the world is made: in its mesh, its body, its part and the rays' tree.
constexpr std::uint64_t kBytesPerFace = 250;

// Few objects of a scene can be many triangles: a sphere is some ten thousand.
std::vector<LoadedObject> loadAll(const Scene& scene, Reporter& reporter, MeshStore* meshes) {
    std::vector<LoadedObject> loaded;
    std::uint64_t faces = 0;
    for (const ObjectSettings& object : scene.objects) {
        loaded.push_back(loadObject(object, scene, reporter, meshes));
        faces += loaded.back().mesh().faceCount();
        requireMemory(scene.file.string(),
                      fmt::format("the {} triangles of its first {} objects of {}", faces,
                                  loaded.size(), scene.objects.size()),
                      faces * kBytesPerFace, "use fewer objects, or meshes with fewer triangles");
    }
    return loaded;
}

}  // namespace

World::World(const Scene& scene, Reporter& reporter, MeshStore* meshes)
    : World(scene, loadAll(scene, reporter, meshes), reporter) {}

World::World(Scene scene, std::vector<LoadedObject> loaded, Reporter& reporter)
    : scene_(std::move(scene)), loaded_(std::move(loaded)) {
    chooseOrigin();
    makeBodies(reporter);
    makeParts();
    makeVolumes(reporter);
    makeLights();
    camera_.emplace(scene_.camera, scene_.film.width, scene_.film.height, originMm_);
}

void World::lookFrom(const Scene& scene) {
    scene_.camera = scene.camera;
    scene_.frame = scene.frame;
    scene_.quality.cameraSeed = scene.quality.cameraSeed;
    camera_.emplace(scene_.camera, scene_.film.width, scene_.film.height, originMm_);
}

const TranslucentMaterial& World::materialOf(const Body& body) const {
    return std::get<TranslucentMaterial>(material(body.material));
}

// The middle of what is translucent, or else of everything.
void World::chooseOrigin() {
    DBounds translucent, all;
    for (std::size_t k = 0; k < loaded_.size(); ++k) {
        DBounds box;
        for (const DVec3& p : loaded_[k].mesh().positions)
            box.add(DVec3(loaded_[k].worldFromObject * glm::dvec4(p, 1.0)));
        all.add(box);
        if (std::holds_alternative<TranslucentMaterial>(material(scene_.objects[k].material)))
            translucent.add(box);
    }
    originMm_ = (translucent.isEmpty() ? all : translucent).centre();
}

void World::makeBodies(Reporter& reporter) {
    std::vector<std::vector<int>> members;
    std::map<std::string, std::size_t> groups;
    for (int k = 0; k < static_cast<int>(loaded_.size()); ++k) {
        const ObjectSettings& object = scene_.objects[static_cast<std::size_t>(k)];
        if (!std::holds_alternative<TranslucentMaterial>(material(object.material))) continue;
        if (object.group.empty()) {
            members.push_back({k});
            continue;
        }
        const auto [place, isNew] = groups.try_emplace(object.group, members.size());
        if (isNew) members.emplace_back();
        members[place->second].push_back(k);
    }
    for (const std::vector<int>& group : members) {
        const ObjectSettings& first = scene_.objects[static_cast<std::size_t>(group.front())];
        for (const int k : group) {
            const ObjectSettings& object = scene_.objects[static_cast<std::size_t>(k)];
            if (object.material != first.material)
                throw Error(
                    ErrorKind::BadInput, placeOf(object, scene_),
                    fmt::format("object \"{}\" is in group \"{}\" with \"{}\" but has another "
                                "material",
                                object.name, object.group, first.name),
                    "a group is one body: give its objects one material, or split the group");
        }
        describeShells(group, turnNestedShells(group, loaded_, scene_), reporter);
        bodies_.push_back(joinBody(first.group.empty() ? first.name : first.group, group, loaded_,
                                   scene_, originMm_));
        describeBody(bodies_.back(), reporter);
    }
}

void World::describeShells(const std::vector<int>& group, const std::vector<int>& turned,
                           Reporter& reporter) const {
    for (const int k : group) {
        const std::string& name = scene_.objects[static_cast<std::size_t>(k)].name;
        const std::string& wasInward = loaded_[static_cast<std::size_t>(k)].shape->wasInward;
        if (std::find(turned.begin(), turned.end(), k) != turned.end())
            reporter.info("mesh", name + ": lies inside its group: the wall of a hollow");
        else if (!wasInward.empty())
            reporter.warn("mesh", name + ": " + wasInward);
    }
}

void World::describeBody(const Body& body, Reporter& reporter) const {
    const TranslucentMaterial& translucent = materialOf(body);
    const DVec3 size = body.mesh.bounds().size();
    const DRgb mfp = translucent.medium.meanFreePathMm();
    reporter.info(
        "scene", fmt::format("{}: {} triangles, {:.4g} x {:.4g} x {:.4g} mm, area {:.5g} mm2; mean "
                             "free path {:.4g} {:.4g} {:.4g} mm",
                             body.name, body.mesh.faceCount(), size.x, size.y, size.z,
                             body.mesh.area(), mfp.x, mfp.y, mfp.z));
    for (const std::string& sentence : diffusionWarnings(translucent.medium, minComponent(size),
                                                         translucent.profileOptions.boundary))
        reporter.warn("medium", body.name + ": " + sentence);
    if (!body.closed)
        reporter.warn("mesh",
                      fmt::format("{}: the surface is not closed: diffusion holds, but single "
                                  "scattering has no inside there; close it, or set "
                                  "\"singleScattering\": false",
                                  body.name));
    if (!body.closed && translucent.onShape)
        reporter.warn("mesh", fmt::format("{}: diffusion cannot be solved on a shape without an "
                                          "inside: the profile \"{}\" stands in; close the open "
                                          "edges: {}",
                                          body.name, translucent.profile, holesOf(body)));
}

// By object, in its own space, where the user meets them again.
std::string World::holesOf(const Body& body) const {
    std::string list;
    for (const int k : body.objects) {
        const LoadedMesh& shape = *loaded_[static_cast<std::size_t>(k)].shape;
        if (shape.closed) continue;
        const std::string& name = scene_.objects[static_cast<std::size_t>(k)].name;
        list += fmt::format("{}{} ({})", list.empty() ? "" : "; ", name,
                            shape.holes.empty() ? "edges of an odd number of faces" : shape.holes);
    }
    return list;
}

void World::makeParts() {
    parts_.resize(loaded_.size());
    std::vector<RayScene::Geometry> geometries(loaded_.size());
    for (std::size_t k = 0; k < loaded_.size(); ++k) {
        const DMat4& m = loaded_[k].worldFromObject;
        TriangleMesh mesh = transformedMesh(loaded_[k].mesh(), DMat3(m), DVec3(m[3]) - originMm_);
        Part& part = parts_[k];
        for (const DVec3& p : mesh.positions) {
            part.positions.push_back(Vec3(p));
            bounds_.add(part.positions.back());
        }
        part.normals = std::move(mesh.normals);
        part.faces = std::move(mesh.faces);
    }
    for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
        const Body& body = bodies_[static_cast<std::size_t>(b)];
        for (std::size_t k = 0; k < body.objects.size(); ++k) {
            Part& part = parts_[static_cast<std::size_t>(body.objects[k])];
            part.body = b;
            part.firstBodyFace = body.firstFace[k];
        }
    }
    for (std::size_t k = 0; k < parts_.size(); ++k) geometries[k] = geometry(k);
    rays_.emplace(geometries);
}

void World::makeVolumes(Reporter& reporter) {
    for (const VolumeSettings& settings : scene_.volumes)
        volumes_.push_back(loadVolume(settings, scene_, originMm_, reporter));
}

void World::makeGlows() {
    glows_.resize(volumes_.size());
    for (std::size_t v = 0; v < volumes_.size(); ++v) {
        if (!volumes_[v]->glows()) continue;
        auto light = std::make_unique<VolumeLight>(*volumes_[v], static_cast<int>(v));
        glows_[v] = {light.get(), lights_.size()};
        lights_.push_back(std::move(light));
    }
}

RayScene::Geometry World::geometry(std::size_t object) const {
    const Part& part = parts_[object];
    return {part.positions, part.faces, part.body >= 0 ? bodyMask(part.body) : 1u};
}

void World::makeLights() {
    for (const LightSettings& settings : scene_.lights)
        lights_.push_back(makeLight(settings, originMm_));
    emitters_.assign(scene_.objects.size(), nullptr);
    emitterIndices_.assign(scene_.objects.size(), 0);
    for (std::size_t k = 0; k < scene_.objects.size(); ++k) {
        const auto* emitter = std::get_if<EmitterMaterial>(&material(scene_.objects[k].material));
        if (!emitter) continue;
        std::vector<MeshLight::Triangle> triangles;
        for (const UVec3& f : parts_[k].faces)
            triangles.push_back(
                {parts_[k].positions[f.x], parts_[k].positions[f.y], parts_[k].positions[f.z]});
        auto light = std::make_unique<MeshLight>(
            std::move(triangles), MeshLight::Emission{emitter->radiance, emitter->twoSided});
        emitters_[k] = light.get();
        hasEmitters_ = true;
        emitterIndices_[k] = lights_.size();
        lights_.push_back(std::move(light));
    }
    makeGlows();
    Bounds target;
    for (const Body& body : bodies_)
        for (const int object : body.objects)
            for (const Vec3& p : parts_[static_cast<std::size_t>(object)].positions) target.add(p);
    picker_.emplace(lights_, target.isEmpty() ? bounds_ : target);
    for (std::size_t k = 0; k < scene_.lights.size(); ++k)  // emitters come after them
        if (!lights_[k]->isDelta())
            visibleLights_.push_back({lights_[k].get(), picker_->pmf(k), lights_[k]->isInfinite()});
}

SurfaceHit World::surfaceAt(const Hit& hit) const {
    const Part& part = parts_[hit.geometry];
    SurfaceHit surface;
    const RayScene::Place place = rays_->place(hit);
    surface.position = place.position;
    surface.step = place.step;
    surface.geometricNormal = hit.normal;
    surface.shadingNormal = hit.normal;
    surface.distance = hit.t;
    surface.object = static_cast<int>(hit.geometry);
    surface.material = scene_.objects[hit.geometry].material;
    surface.body = part.body;
    surface.face = hit.face;
    surface.bodyFace = part.firstBodyFace + hit.face;
    surface.barycentrics = {hit.u, hit.v};
    if (!part.normals.empty()) {
        const UVec3 v = part.faces[hit.face];
        const Vec3 n = part.normals[v.x] * (1.0f - hit.u - hit.v) + part.normals[v.y] * hit.u +
                       part.normals[v.z] * hit.v;
        const float length = glm::length(n);
        if (length > 1e-6f) surface.shadingNormal = n / length;
        if (glm::dot(surface.shadingNormal, hit.normal) < 0)
            surface.shadingNormal = -surface.shadingNormal;
    }
    return surface;
}

SurfaceHit World::surfaceOf(int bodyIndex, FaceIndex bodyFace, const Vec2& barycentrics) const {
    const Body& body = bodies_[static_cast<std::size_t>(bodyIndex)];
    const auto after = std::upper_bound(body.firstFace.begin(), body.firstFace.end(), bodyFace);
    const auto member = static_cast<std::size_t>(after - body.firstFace.begin() - 1);
    Hit hit;
    hit.geometry = static_cast<std::uint32_t>(body.objects[member]);
    hit.face = bodyFace - body.firstFace[member];
    hit.u = barycentrics.x;
    hit.v = barycentrics.y;
    // In double: a sliver may have no area left in float.
    hit.normal =
        Vec3(body.worldFromBody.transformDirection(glm::normalize(body.mesh.faceCross(bodyFace))));
    return surfaceAt(hit);
}

}  // namespace sss
