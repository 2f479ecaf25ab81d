#include "sss/world/volume_loader.h"

#include "sss/base/error.h"
#include "sss/world/body.h"
#include "sss/world/object_loader.h"

#include <fmt/core.h>

namespace sss {
namespace {

DBounds boundsOf(const Shape& shape, const TriangleMesh& mesh) {
    // A sphere's triangles fall short of it.
    if (const auto* sphere = std::get_if<SphereShape>(&shape))
        return {DVec3(-sphere->radiusMm), DVec3(sphere->radiusMm)};
    return mesh.bounds();
}

VolumePlace::Part partOf(const Shape& shape) {
    if (std::holds_alternative<BoxShape>(shape)) return VolumePlace::Part::Cube;
    if (std::holds_alternative<SphereShape>(shape)) return VolumePlace::Part::Ball;
    return VolumePlace::Part::Mesh;
}

}  // namespace

std::unique_ptr<Volume> loadVolume(const VolumeSettings& settings, const Scene& scene,
                                   const DVec3& originMm, Reporter& reporter) {
    ObjectSettings object;
    object.name = settings.name;
    object.shape = settings.shape;
    object.transform = settings.transform;
    object.normals = NormalsMode::Flat;
    object.line = settings.line;
    object.column = settings.column;
    const LoadedObject loaded = loadObject(object, scene, reporter);
    if (!loaded.closed())
        throw Error(ErrorKind::BadInput, placeOf(object, scene),
                    fmt::format("the surface of the volume \"{}\" is not closed, so that it has no "
                                "inside",
                                settings.name),
                    "close the mesh, or take a box or a sphere around it");
    VolumePlace place;
    place.part = partOf(settings.shape);
    const DBounds box = boundsOf(settings.shape, loaded.mesh());
    const DMat4 worldFromObject = glm::translate(DMat4(1.0), -originMm) * loaded.worldFromObject;
    place.worldFromUnit = glm::scale(glm::translate(worldFromObject, box.lo), box.size());
    if (place.part == VolumePlace::Part::Mesh)
        place.mesh =
            transformedMesh(loaded.mesh(), DMat3(worldFromObject), DVec3(worldFromObject[3]));
    const DVec3 size = box.size();
    auto volume = std::make_unique<Volume>(settings, std::move(place));
    reporter.info("scene", fmt::format("{}: a volume of {:.4g} x {:.4g} x {:.4g} mm{}{}",
                                       settings.name, size.x, size.y, size.z,
                                       settings.grid ? ", its density from a grid" : "",
                                       volume->glows() ? ", glowing" : ""));
    return volume;
}

}  // namespace sss
