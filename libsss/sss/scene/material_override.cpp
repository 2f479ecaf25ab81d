#include "sss/scene/material_override.h"

#include "sss/base/error.h"
#include "sss/base/near_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace sss {

BoundaryModel boundaryModel(std::string_view name, const std::string& where) {
    constexpr std::array<std::string_view, 2> kNames{"exact", "polynomial"};
    if (name == kNames[0]) return BoundaryModel::Exact;
    if (name == kNames[1]) return BoundaryModel::Polynomial;
    throw Error(ErrorKind::Usage, where, fmt::format("there is no boundary {}", inQuotes(name)),
                nameHint(name, kNames));
}

void setModel(Scene& scene, const std::string& name, const std::string& where) {
    constexpr std::string_view kShape = "shape";
    std::vector<std::string_view> names{kShape};
    for (const ProfileKind& kind : profileTable())
        if (!kind.name.starts_with("multipole")) names.push_back(kind.name);
    if (std::find(names.begin(), names.end(), name) == names.end())
        throw Error(
            ErrorKind::Usage, where,
            fmt::format("there is no model of diffusion {} for a whole scene", inQuotes(name)),
            nameHint(name, names));
    for (NamedMaterial& material : scene.materials) {
        auto* translucent = std::get_if<TranslucentMaterial>(&material.material);
        if (!translucent) continue;
        translucent->onShape = name == kShape;
        if (translucent->onShape) continue;
        translucent->profile = name;
        translucent->profileOptions.slabThicknessMm.reset();
    }
}

void setBoundary(Scene& scene, BoundaryModel boundary) {
    for (NamedMaterial& material : scene.materials) {
        if (auto* translucent = std::get_if<TranslucentMaterial>(&material.material))
            translucent->profileOptions.boundary = boundary;
    }
}

}  // namespace sss
