#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

/// The shape of an object: "mesh", a file, or "shape", a built-in one.
const Kind<Shape>& shapeKind(const Node& object);
std::span<const Kind<Shape>> shapeKinds();

/// A name for an object that has none: its mesh file's, or its shape's.
std::string shapeName(const Kind<Shape>& kind, const Shape& shape);

}  // namespace sss
