#include "sss/world/object_loader.h"

#include "sss/base/error.h"
#include "sss/geom/mesh_io.h"
#include "sss/geom/mesh_repair.h"
#include "sss/geom/mesh_report.h"
#include "sss/geom/normals.h"
#include "sss/geom/rigid.h"
#include "sss/geom/shapes.h"

#include <fmt/core.h>

#include <cmath>
#include <initializer_list>
#include <utility>

namespace sss {
namespace {

constexpr double kCreaseDegrees = 40;

// One overload a shape; mesh files are the only ones with something to report.
struct ShapeMaker {
    double mmPerUnit;
    MeshReport& report;

    TriangleMesh operator()(const MeshFileShape& shape) const {
        MeshFile file = readMesh(shape.path);
        report = file.report;
        for (DVec3& p : file.mesh.positions) p *= mmPerUnit;
        return std::move(file.mesh);
    }
    TriangleMesh operator()(const SphereShape& s) const { return makeSphere(s.radiusMm); }
    TriangleMesh operator()(const RectangleShape& s) const {
        return makeRectangle(s.widthMm, s.heightMm);
    }
    TriangleMesh operator()(const DiskShape& s) const { return makeDisk(s.radiusMm); }
    TriangleMesh operator()(const BoxShape& s) const { return makeBox(s.sizeMm); }
    TriangleMesh operator()(const CylinderShape& s) const {
        return makeCylinder(s.radiusMm, s.heightMm);
    }
};

DVec3 transformed(const DMat4& m, const DVec3& p) { return DVec3(m * glm::dvec4(p, 1.0)); }

DMat4 fitted(const FitStep& fit, const DMat4& before, const TriangleMesh& mesh,
             const ObjectSettings& object, const Scene& scene) {
    DBounds box;
    for (const DVec3& p : mesh.positions) box.add(transformed(before, p));
    // A flat object that was rotated has a height of rounding.
    if (!(box.size().y > 1e-9 * box.diagonal()))
        throw Error(
            ErrorKind::BadInput, placeOf(object, scene),
            fmt::format("\"{}\" cannot be fitted to a height: it is flat in y", object.name),
            "rotate it before the fit, or use a scale");
    const double scale = fit.heightMm / box.size().y;
    DMat4 m = glm::translate(DMat4(1.0), fit.centre);
    m = glm::scale(m, DVec3(scale));
    return glm::translate(m, -box.centre());
}

DMat4 resolveTransform(const ObjectSettings& object, const TriangleMesh& mesh, const Scene& scene) {
    DMat4 worldFromObject(1.0);
    for (const TransformStep& step : object.transform) {
        if (const auto* matrix = std::get_if<DMat4>(&step))
            worldFromObject = *matrix * worldFromObject;
        else
            worldFromObject =
                fitted(std::get<FitStep>(step), worldFromObject, mesh, object, scene) *
                worldFromObject;
    }
    return worldFromObject;
}

void chooseNormals(TriangleMesh& mesh, NormalsMode mode) {
    switch (mode) {
        case NormalsMode::Flat:
            mesh.normals.clear();
            break;
        case NormalsMode::Smooth:
            mesh.normals = angleWeightedNormals(mesh);
            break;
        case NormalsMode::Auto:
            if (mesh.normals.empty()) mesh = withCreases(mesh, kCreaseDegrees);
            break;
    }
}

// Whether repair would change something; a report that was not made says nothing.
bool needsRepair(const MeshReport& report) {
    return report.faces == 0 || report.degenerateFaces + report.duplicateFaces +
                                        report.unreferencedVertices + report.flippedFaces >
                                    0;
}

// Where a user finds the surface: the file, or else the object of the scene.
std::string sourceOf(const ObjectSettings& object) {
    const auto* file = std::get_if<MeshFileShape>(&object.shape);
    return file ? file->path.string() : object.name;
}

// What a surface is made from: equal keys, equal meshes.
struct KeyMaker {
    std::string operator()(const MeshFileShape& s) const { return "mesh " + s.path.string(); }
    std::string operator()(const SphereShape& s) const { return sizes("sphere", {s.radiusMm}); }
    std::string operator()(const RectangleShape& s) const {
        return sizes("rectangle", {s.widthMm, s.heightMm});
    }
    std::string operator()(const DiskShape& s) const { return sizes("disk", {s.radiusMm}); }
    std::string operator()(const BoxShape& s) const {
        return sizes("box", {s.sizeMm.x, s.sizeMm.y, s.sizeMm.z});
    }
    std::string operator()(const CylinderShape& s) const {
        return sizes("cylinder", {s.radiusMm, s.heightMm});
    }
    static std::string sizes(const char* name, std::initializer_list<double> mm) {
        std::string key = name;
        for (const double size : mm) key += fmt::format(" {:a}", size);
        return key;
    }
};

std::string keyOf(const ObjectSettings& object, double mmPerUnit) {
    return fmt::format("{} {} {:a} {}", object.name, static_cast<int>(object.normals), mmPerUnit,
                       std::visit(KeyMaker{}, object.shape));
}

// The sentence about a mesh that is inward as a whole, taken out of its report; or nothing.
std::string takeInward(MeshReport& report, double mmPerUnit) {
    if (report.flippedComponents == 0 || report.flippedComponents != report.components ||
        report.inconsistentEdges > 0)
        return {};
    MeshReport inward;
    inward.flippedFaces = std::exchange(report.flippedFaces, 0);
    inward.flippedComponents = report.flippedComponents;
    return describe(inward, mmPerUnit).front();
}

std::shared_ptr<const LoadedMesh> loadMesh(const ObjectSettings& object, double mmPerUnit,
                                           bool joins, Reporter& reporter) {
    auto loaded = std::make_shared<LoadedMesh>();
    MeshReport report;
    loaded->mesh = std::visit(ShapeMaker{mmPerUnit, report}, object.shape);
    const std::size_t facesRead = loaded->mesh.faceCount();
    // Reported in the mesh's own unit, before repair: what the user has to mend.
    MeshReport told = report;
    if (joins) loaded->wasInward = takeInward(told, mmPerUnit);
    for (const std::string& sentence : describe(told, mmPerUnit))
        reporter.warn("mesh", object.name + ": " + sentence);
    const bool isRepaired = needsRepair(report);
    if (isRepaired) {
        const RemovedParts removed = removeUnusable(loaded->mesh);
        if (loaded->mesh.faces.empty())
            throw Error(ErrorKind::BadInput, sourceOf(object),
                        fmt::format("none of its {} faces has an area", facesRead),
                        "check the mesh and its scale");
        if (removed.degenerateFaces + removed.duplicateFaces > 0)
            reporter.info(
                "mesh", fmt::format("{}: removed {} faces without area and {} duplicates",
                                    object.name, removed.degenerateFaces, removed.duplicateFaces));
        repairWinding(loaded->mesh);
        report = inspectMesh(loaded->mesh);
    }
    loaded->closed = report.closed;
    loaded->holes = describeHoles(report, isRepaired ? 1.0 : mmPerUnit);
    chooseNormals(loaded->mesh, object.normals);
    Hasher hasher;
    addMesh(hasher, loaded->mesh);
    loaded->content = hasher.finish();
    return loaded;
}

}  // namespace

void MeshStore::nextFrame() {
    std::erase_if(entries_, [](const auto& entry) { return !entry.second.isUsed; });
    for (auto& [key, entry] : entries_) entry.isUsed = false;
}

std::shared_ptr<const LoadedMesh> MeshStore::find(const std::string& key) {
    const auto found = entries_.find(key);
    if (found == entries_.end()) return nullptr;
    found->second.isUsed = true;
    return found->second.mesh;
}

void MeshStore::add(const std::string& key, std::shared_ptr<const LoadedMesh> mesh) {
    entries_[key] = {std::move(mesh), true};
}

std::string placeOf(const ObjectSettings& object, const Scene& scene) {
    return fmt::format("{}:{}:{}", scene.file.string(), object.line, object.column);
}

void addMesh(Hasher& hasher, const TriangleMesh& mesh) {
    hasher.add(std::span<const DVec3>(mesh.positions));
    hasher.add(std::span<const Vec3>(mesh.normals));
    hasher.add(std::span<const UVec3>(mesh.faces));
}

LoadedObject loadObject(const ObjectSettings& object, const Scene& scene, Reporter& reporter,
                        MeshStore* store) {
    const double mmPerUnit = scene.metersPerUnit * 1000.0;
    LoadedObject loaded;
    const std::string key = keyOf(object, mmPerUnit);
    if (store != nullptr) loaded.shape = store->find(key);
    if (loaded.shape == nullptr) {
        const bool joins = !object.group.empty() &&
                           std::holds_alternative<TranslucentMaterial>(
                               scene.materials[static_cast<std::size_t>(object.material)].material);
        loaded.shape = loadMesh(object, mmPerUnit, joins, reporter);
        if (store != nullptr) store->add(key, loaded.shape);
    }
    loaded.worldFromObject = resolveTransform(object, loaded.mesh(), scene);
    // Steps that are sound one by one may not be together.
    static_cast<void>(polarDecompose(DMat3(loaded.worldFromObject), placeOf(object, scene)));
    return loaded;
}

}  // namespace sss
