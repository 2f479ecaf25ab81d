#include "sss/scene/scene_reader.h"

#include "sss/base/error.h"
#include "sss/scene/animation.h"
#include "sss/scene/camera_reader.h"
#include "sss/scene/film_reader.h"
#include "sss/scene/light_reader.h"
#include "sss/scene/material_reader.h"
#include "sss/scene/object_reader.h"
#include "sss/scene/quality_reader.h"
#include "sss/scene/volume_reader.h"

#include <fmt/format.h>

namespace sss {
namespace {

constexpr std::string_view kUnitHint =
    "add \"metersPerUnit\": the length of one scene unit in metres, 0.001 if you model in mm, "
    "0.01 in cm, 1 in m";

double metersPerUnitOf(const Node& root, std::optional<double> given) {
    if (!given)
        return number(memberNode(root, "metersPerUnit", std::string(kUnitHint)), kUnitRange);
    if (!(*given >= kUnitRange.low && *given <= kUnitRange.high)) {
        throw Error(ErrorKind::BadInput, root.context.file,
                    fmt::format("metersPerUnit is given as {}", *given),
                    fmt::format("it must be from {} to {}", kUnitRange.low, kUnitRange.high));
    }
    return *given;
}

constexpr Field<Scene> kSceneFields[] = {
    {"$schema", [](Scene&, const Node& n) { text(n); }},  // for editors
    {"comment", [](Scene&, const Node& n) { text(n); }},  // for people
    // Read first, because the lengths need it. Checked here too, for when it is overruled.
    {"metersPerUnit", [](Scene&, const Node& n) { number(n, kUnitRange); }},
    {"referenceFrame",
     [](Scene& s, const Node& n) { s.referenceFrame = wholeNumber(n, -999999, 999999); }},
    {"camera", [](Scene& s, const Node& n) { s.camera = readCamera(n); }, true},
    {"film", [](Scene& s, const Node& n) { s.film = readFilm(n); }},
    {"quality", [](Scene& s, const Node& n) { s.quality = readQuality(n); }},
    {"materials", [](Scene& s, const Node& n) { s.materials = readMaterials(n); }, true},
    {"objects", nullptr, true},  // read last, because they name materials
    {"lights", [](Scene& s, const Node& n) { s.lights = readLights(n); }},
    {"volumes", [](Scene& s, const Node& n) { s.volumes = readVolumes(n); }},
};

Scene sceneOf(const JsonValue& root, const std::filesystem::path& file,
              std::optional<double> metersPerUnit) {
    ReadContext context{file.string(), file.parent_path()};
    const Node node{root, "the scene", context};
    Scene scene;
    scene.file = file;
    scene.metersPerUnit = metersPerUnitOf(node, metersPerUnit);
    scene.film = defaultFilm();
    context.mmPerUnit = scene.metersPerUnit * 1000.0;
    context.materials = &scene.materials;

    FieldSet fields;
    fields.add(scene, kSceneFields);
    fields.read(node);
    scene.objects = readObjects(memberNode(node, "objects", ""));
    return scene;
}

}  // namespace

Scene readSceneJson(const JsonValue& root, const std::filesystem::path& file,
                    std::optional<double> metersPerUnit, int frame) {
    Scene scene = sceneOf(sceneAt(root, frame, file.string()), file, metersPerUnit);
    scene.frame = frame;
    return scene;
}

Scene readScene(const std::filesystem::path& file, std::optional<double> metersPerUnit, int frame) {
    return readSceneJson(readJsonFile(file), file, metersPerUnit, frame);
}

Scene readSceneText(std::string_view text, const std::filesystem::path& file,
                    std::optional<double> metersPerUnit, int frame) {
    return readSceneJson(parseJson(text, file.string()), file, metersPerUnit, frame);
}

std::vector<KeyList> sceneKeys() {
    std::vector<KeyList> out{listRows<Scene>("scene", kSceneFields), cameraKeys(), filmKeys(),
                             qualityKeys()};
    listMaterialKeys(out);
    listObjectKeys(out);
    listLightKeys(out);
    listVolumeKeys(out);
    listAnimationKeys(out);
    return out;
}

}  // namespace sss
