#include "sss/scene/material_override.h"

#include "sss/base/error.h"
#include "sss/base/near_name.h"

#include <fmt/format.h>

#include <array>

namespace sss {

BoundaryModel boundaryModel(std::string_view name, const std::string& where) {
    constexpr std::array<std::string_view, 2> kNames{"exact", "polynomial"};
    if (name == kNames[0]) return BoundaryModel::Exact;
    if (name == kNames[1]) return BoundaryModel::Polynomial;
    throw Error(ErrorKind::Usage, where, fmt::format("there is no boundary {}", inQuotes(name)),
                nameHint(name, kNames));
}

bool diffusionOnShape(std::string_view name, const std::string& where) {
    constexpr std::array<std::string_view, 2> kNames{"profile", "shape"};
    if (name == kNames[0]) return false;
    if (name == kNames[1]) return true;
    throw Error(ErrorKind::Usage, where,
                fmt::format("there is no model of diffusion {}", inQuotes(name)),
                nameHint(name, kNames));
}

void setDiffusion(Scene& scene, bool onShape) {
    for (NamedMaterial& material : scene.materials)
        if (auto* translucent = std::get_if<TranslucentMaterial>(&material.material))
            translucent->onShape = onShape;
}

void setBoundary(Scene& scene, BoundaryModel boundary) {
    for (NamedMaterial& material : scene.materials) {
        if (auto* translucent = std::get_if<TranslucentMaterial>(&material.material))
            translucent->profileOptions.boundary = boundary;
    }
}

}  // namespace sss
