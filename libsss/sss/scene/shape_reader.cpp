#include "sss/scene/shape_reader.h"

#include <array>

namespace sss {
namespace {

constexpr Field<MeshFileShape> kMeshFields[] = {
    {"mesh", [](MeshFileShape& s, const Node& n) { s.path = filePath(n); }, true},
};
constexpr Field<SphereShape> kSphereFields[] = {
    {"shape"},
    {"radius", [](SphereShape& s, const Node& n) { s.radiusMm = length(n, kSizeRange); }, true},
};
constexpr Field<RectangleShape> kRectangleFields[] = {
    {"shape"},
    {"width", [](RectangleShape& s, const Node& n) { s.widthMm = length(n, kSizeRange); }, true},
    {"height", [](RectangleShape& s, const Node& n) { s.heightMm = length(n, kSizeRange); }, true},
};
constexpr Field<DiskShape> kDiskFields[] = {
    {"shape"},
    {"radius", [](DiskShape& s, const Node& n) { s.radiusMm = length(n, kSizeRange); }, true},
};
constexpr Field<BoxShape> kBoxFields[] = {
    {"shape"},
    {"size",
     [](BoxShape& s, const Node& n) { s.sizeMm = vector(n, kSizeRange) * n.context.mmPerUnit; },
     true},
};
constexpr Field<CylinderShape> kCylinderFields[] = {
    {"shape"},
    {"radius", [](CylinderShape& s, const Node& n) { s.radiusMm = length(n, kSizeRange); }, true},
    {"height", [](CylinderShape& s, const Node& n) { s.heightMm = length(n, kSizeRange); }, true},
};

// The first is what the key "mesh" means; the others are the names that "shape" takes.
const Kind<Shape> kShapeKinds[] = {
    {"mesh", MeshFileShape{}, addRows<MeshFileShape, kMeshFields>},
    {"sphere", SphereShape{}, addRows<SphereShape, kSphereFields>},
    {"rectangle", RectangleShape{}, addRows<RectangleShape, kRectangleFields>},
    {"disk", DiskShape{}, addRows<DiskShape, kDiskFields>},
    {"box", BoxShape{}, addRows<BoxShape, kBoxFields>},
    {"cylinder", CylinderShape{}, addRows<CylinderShape, kCylinderFields>},
};

}  // namespace

std::span<const Kind<Shape>> shapeKinds() { return kShapeKinds; }

const Kind<Shape>& shapeKind(const Node& object) {
    static constexpr std::array<std::string_view, 2> kEither{"mesh", "shape"};
    const bool isObject = object.value.isObject();
    const JsonMember* mesh = isObject ? object.value.find("mesh") : nullptr;
    const JsonMember* shape = isObject ? object.value.find("shape") : nullptr;
    if (mesh == nullptr && shape == nullptr) {
        refuseSlips(object, kEither);
        fail(object, "has neither \"mesh\" nor \"shape\"",
             "name a mesh file, or a shape: sphere, rectangle, disk, box or cylinder");
    }
    if (mesh != nullptr && shape != nullptr) {
        fail(object, shape->keyPlace, object.name + " has both \"mesh\" and \"shape\"",
             "remove one of the two");
    }
    if (mesh != nullptr) return kShapeKinds[0];
    return kindOf<Shape>(object, "shape", shapeKinds().subspan(1));
}

std::string shapeName(const Kind<Shape>& kind, const Shape& shape) {
    const auto* mesh = std::get_if<MeshFileShape>(&shape);
    return mesh == nullptr ? std::string(kind.name) : mesh->path.stem().string();
}

}  // namespace sss
