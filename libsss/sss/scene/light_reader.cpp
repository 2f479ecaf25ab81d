#include "sss/scene/light_reader.h"

#include "sss/scene/light_motion.h"
#include "sss/scene/transform_reader.h"
#include "sss/scene/view.h"

#include <fmt/format.h>

#include <algorithm>

namespace sss {
namespace {

constexpr std::size_t kMostLights = 1000000;

// "type" chooses the table, and "transform" moves what the other keys say.
constexpr Field<PointLight> kPointFields[] = {
    {"type"},
    {"transform"},
    {"position", [](PointLight& l, const Node& n) { l.position = point(n); }, true},
    {"intensity", [](PointLight& l, const Node& n) { l.intensity = rgb(n, kLightRange); }, true},
};

constexpr Field<SpotLight> kSpotFields[] = {
    {"type"},
    {"transform"},
    {"position", [](SpotLight& l, const Node& n) { l.position = point(n); }, true},
    {"lookAt", [](SpotLight& l, const Node& n) { l.lookAt = point(n); }},
    {"intensity", [](SpotLight& l, const Node& n) { l.intensity = rgb(n, kLightRange); }, true},
    {"coneDegrees",
     [](SpotLight& l, const Node& n) {
         l.coneDegrees = number(n, {0, 90, true, false, "degrees"});
     }},
    {"penumbraDegrees",
     [](SpotLight& l, const Node& n) {
         l.penumbraDegrees = number(n, {0, 90, false, false, "degrees"});
     }},
};

void finishSpot(LightSettings& light, const Node& node) {
    auto& spot = std::get<SpotLight>(light);
    DVec3 up{0, 1, 0};
    checkView(node, "position", spot.position, spot.lookAt, up);
    if (node.value.find("penumbraDegrees") == nullptr) {
        spot.penumbraDegrees = std::min(spot.penumbraDegrees, spot.coneDegrees);
    } else if (spot.penumbraDegrees > spot.coneDegrees) {
        fail(node,
             fmt::format("has \"penumbraDegrees\" {} in a cone of {}", spot.penumbraDegrees,
                         spot.coneDegrees),
             "the soft edge lies inside the cone: make it no wider than \"coneDegrees\"");
    }
}

constexpr Field<DirectionalLight> kDirectionalFields[] = {
    {"type"},
    {"transform"},
    {"direction", [](DirectionalLight& l, const Node& n) { l.direction = direction(n); }, true},
    {"irradiance", [](DirectionalLight& l, const Node& n) { l.irradiance = rgb(n, kLightRange); },
     true},
};

void normaliseDirection(LightSettings& light, const Node&) {
    auto& sun = std::get<DirectionalLight>(light);
    sun.direction = glm::normalize(sun.direction);
}

constexpr Field<RectangleLight> kRectangleFields[] = {
    {"type"},
    {"transform"},
    {"centre", [](RectangleLight& l, const Node& n) { l.centre = point(n); }, true},
    {"lookAt", [](RectangleLight& l, const Node& n) { l.lookAt = point(n); }},
    {"up", [](RectangleLight& l, const Node& n) { l.up = direction(n); }},
    {"width", [](RectangleLight& l, const Node& n) { l.widthMm = length(n, kSizeRange); }, true},
    {"height", [](RectangleLight& l, const Node& n) { l.heightMm = length(n, kSizeRange); }, true},
    {"radiance", [](RectangleLight& l, const Node& n) { l.radiance = rgb(n, kLightRange); }, true},
    {"twoSided", [](RectangleLight& l, const Node& n) { l.twoSided = yesOrNo(n); }},
};

void finishRectangle(LightSettings& light, const Node& node) {
    auto& lamp = std::get<RectangleLight>(light);
    checkView(node, "centre", lamp.centre, lamp.lookAt, lamp.up);
}

constexpr Field<SphereLight> kSphereFields[] = {
    {"type"},
    {"transform"},
    {"centre", [](SphereLight& l, const Node& n) { l.centre = point(n); }, true},
    {"radius", [](SphereLight& l, const Node& n) { l.radiusMm = length(n, kSizeRange); }, true},
    {"radiance", [](SphereLight& l, const Node& n) { l.radiance = rgb(n, kLightRange); }, true},
};

constexpr Field<EnvironmentLight> kEnvironmentFields[] = {
    {"type"},
    {"radiance", [](EnvironmentLight& l, const Node& n) { l.radiance = rgb(n, kLightRange); }},
    {"map", [](EnvironmentLight& l, const Node& n) { l.map = filePath(n); }},
    {"rotationDegrees",
     [](EnvironmentLight& l, const Node& n) { l.rotationDegrees = number(n, kAngleRange); }},
};

void finishEnvironment(LightSettings&, const Node& node) {
    if (node.value.find("radiance") != nullptr || node.value.find("map") != nullptr) return;
    fail(node, "gives no light", "add \"radiance\", or \"map\" with the name of a lat-long EXR");
}

const Kind<LightSettings> kLightKinds[] = {
    {"point", PointLight{}, addRows<PointLight, kPointFields>},
    {"spot", SpotLight{}, addRows<SpotLight, kSpotFields>, finishSpot},
    {"directional", DirectionalLight{}, addRows<DirectionalLight, kDirectionalFields>,
     normaliseDirection},
    {"rectangle", RectangleLight{}, addRows<RectangleLight, kRectangleFields>, finishRectangle},
    {"sphere", SphereLight{}, addRows<SphereLight, kSphereFields>},
    {"environment", EnvironmentLight{}, addRows<EnvironmentLight, kEnvironmentFields>,
     finishEnvironment},
};

}  // namespace

std::vector<LightSettings> readLights(const Node& node) {
    std::vector<LightSettings> lights;
    bool haveEnvironment = false;
    for (const Node& entry : entries(node, 0, kMostLights)) {
        const auto& kind = kindOf<LightSettings>(entry, "type", kLightKinds);
        LightSettings light = readKind(kind, entry);
        if (entry.value.find("transform") != nullptr)
            light = movedLight(light, readMotion(memberNode(entry, "transform", "")));
        if (std::holds_alternative<EnvironmentLight>(light)) {
            if (haveEnvironment) fail(entry, "is a second environment", "keep one of the two");
            haveEnvironment = true;
        }
        lights.push_back(std::move(light));
    }
    return lights;
}

void listLightKeys(std::vector<KeyList>& out) {
    listKinds<LightSettings>("light", kLightKinds, out);
}

}  // namespace sss
