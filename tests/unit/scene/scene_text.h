#pragma once
#include "sss/base/error.h"
#include "sss/scene/scene_reader.h"

#include <fmt/format.h>

#include <optional>
#include <string>

namespace sss {

inline constexpr std::string_view kMilk =
    R"("milk": {"type": "translucent", "medium": "Skimmilk"})";
inline constexpr std::string_view kBall = R"({"shape": "sphere", "radius": 1, "material": "milk"})";

/// A scene of which a test writes the parts that it is about.
struct Parts {
    std::string units = "0.001";
    std::string camera = R"({"position": [0, 0, 100]})";
    std::string materials = std::string(kMilk);
    std::string objects = std::string(kBall);
    std::string rest = {};  // further members, each with a comma before it
};

inline Scene read(const Parts& parts, std::optional<double> metersPerUnit = {}) {
    return readSceneText(
        fmt::format(
            R"({{"metersPerUnit": {}, "camera": {}, "materials": {{{}}}, "objects": [{}]{}}})",
            parts.units, parts.camera, parts.materials, parts.objects, parts.rest),
        "/scenes/here/test.json", metersPerUnit);
}

inline std::string complaint(const Parts& parts) {
    try {
        read(parts);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

inline const TranslucentMaterial& translucent(const Scene& scene) {
    return std::get<TranslucentMaterial>(scene.materials.at(0).material);
}

}  // namespace sss
