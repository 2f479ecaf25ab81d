#include "sss/app/scene_frames.h"

#include "sss/base/error.h"
#include "sss/base/hash.h"
#include "sss/integrate/spacing.h"
#include "sss/scene/animation.h"
#include "sss/scene/scene_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace sss {
namespace {

const JsonValue* memberOf(const JsonValue& object, std::string_view key) {
    const JsonMember* found = object.isObject() ? object.find(key) : nullptr;
    return found == nullptr ? nullptr : &found->value;
}

// Motion without deformation is what body space is for.
bool isMotion(const JsonValue& step) {
    return memberOf(step, "translate") != nullptr || memberOf(step, "rotate") != nullptr;
}

bool mayDeform(const JsonValue& object) {
    if (!object.isObject()) return false;
    for (const JsonMember& member : object.members()) {
        if (member.key != "transform" || !member.value.isArray()) {
            if (isAnimated(member.value) ||
                (member.key == "mesh" && isAnimated(JsonValue::object().set("mesh", member.value))))
                return true;
            continue;
        }
        for (const JsonValue& step : member.value.items())
            if (!isMotion(step) && isAnimated(step)) return true;
    }
    return false;
}

bool anyMayDeform(const JsonValue& root) {
    const JsonValue* objects = memberOf(root, "objects");
    return objects != nullptr && objects->isArray() &&
           std::ranges::any_of(objects->items(), mayDeform);
}

}  // namespace

SceneFrames::SceneFrames(std::filesystem::path file, std::optional<double> metersPerUnit,
                         std::function<void(Scene&)> adjust, Reporter& reporter)
    : file_(std::move(file)),
      root_(readJsonFile(file_)),
      metersPerUnit_(metersPerUnit),
      adjust_(std::move(adjust)),
      reporter_(reporter) {
    chooseSpacings();
}

// The points of an animated material stay where they are: the finest that any key asks for.
void SceneFrames::chooseSpacings() {
    const JsonValue* materials = memberOf(root_, "materials");
    if (materials == nullptr || !materials->isObject()) return;
    for (const JsonMember& member : materials->members()) {
        if (!isAnimated(member.value)) continue;
        double finest = std::numeric_limits<double>::infinity();
        for (const double frame : keyFrames(member.value)) {
            const Scene scene = at(static_cast<int>(std::lround(frame)));
            for (const NamedMaterial& material : scene.materials) {
                const auto* translucent = std::get_if<TranslucentMaterial>(&material.material);
                if (material.name != member.key || translucent == nullptr) continue;
                const BodyOptics optics(*translucent);
                finest = std::min(finest, spacingFor(optics, scene.quality.tolerance).spacingMm);
            }
        }
        if (std::isfinite(finest)) spacingMm_[member.key] = finest;
    }
}

Scene SceneFrames::at(int frame) const {
    Scene scene = readSceneJson(root_, file_, metersPerUnit_, frame);
    adjust_(scene);
    for (NamedMaterial& material : scene.materials) {
        const auto found = spacingMm_.find(material.name);
        if (found != spacingMm_.end()) material.spacingMm = found->second;
    }
    return scene;
}

std::string SceneFrames::withoutView(int frame) const {
    const JsonValue scene = sceneAt(root_, frame, file_.string());
    JsonValue rest = JsonValue::object();
    for (const JsonMember& member : scene.members())
        if (member.key != "camera") rest.append(member);
    return dump(rest, -1);
}

std::shared_ptr<const World> SceneFrames::world(const Scene& scene, bool& sameWorld) {
    std::string text = withoutView(scene.frame);
    sameWorld = last_ != nullptr && text == lastText_;
    if (sameWorld) {
        last_->lookFrom(scene);
        return last_;
    }
    last_ = std::make_shared<World>(scene, reporter_, &meshes_);
    lastText_ = std::move(text);
    meshes_.nextFrame();
    return last_;
}

const World* SceneFrames::reference(const Scene& scene) {
    if (isReferenceMade_) return reference_.get();
    isReferenceMade_ = true;
    if (!anyMayDeform(root_)) return nullptr;
    SilentReporter silent;
    const int frame = scene.referenceFrame;
    try {
        reference_ = std::make_unique<const World>(at(frame), silent);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Io) throw;
        reporter_.info("scene", fmt::format("points are placed anew in each frame: the reference "
                                            "frame {} cannot be had: {}",
                                            frame, error.what()));
    }
    return reference_.get();
}

const Fingerprint& SceneFrames::contentOf(const std::filesystem::path& file) {
    const auto [place, isNew] = contents_.try_emplace(file);
    if (isNew) {
        std::ifstream in(file, std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(in)),
                                std::istreambuf_iterator<char>());
        place->second = Hasher().add(bytes).finish();
    }
    return place->second;
}

Fingerprint SceneFrames::pictureFingerprint(const Scene& scene) {
    Hasher h;
    h.add(SSS_VERSION).add(dump(sceneAt(root_, scene.frame, file_.string()), -1));
    const QualitySettings& quality = scene.quality;
    h.add(scene.metersPerUnit).add(quality.tolerance).add(quality.spacingMm).add(quality.seed);
    h.add(quality.cameraSeed).add(quality.integrator);
    for (const int n : {scene.film.width, scene.film.height, scene.film.samples})
        h.add(static_cast<std::uint64_t>(n));
    for (const NamedMaterial& material : scene.materials) {
        h.add(material.spacingMm);
        if (const auto* translucent = std::get_if<TranslucentMaterial>(&material.material))
            h.add(static_cast<std::uint64_t>(translucent->profileOptions.boundary))
                .add(translucent->profile)
                .add(std::uint64_t{translucent->onShape});
    }
    const auto addShape = [&](const Shape& shape) {
        if (const auto* mesh = std::get_if<MeshFileShape>(&shape)) h.add(contentOf(mesh->path));
    };
    for (const ObjectSettings& object : scene.objects) addShape(object.shape);
    // Points stand where they were placed in the reference frame.
    if (anyMayDeform(root_)) {
        const JsonValue then = sceneAt(root_, scene.referenceFrame, file_.string());
        h.add(dump(*memberOf(then, "objects"), -1));
        for (const ObjectSettings& object : at(scene.referenceFrame).objects)
            addShape(object.shape);
    }
    for (const LightSettings& light : scene.lights) {
        const auto* environment = std::get_if<EnvironmentLight>(&light);
        if (environment != nullptr && !environment->map.empty()) h.add(contentOf(environment->map));
    }
    for (const VolumeSettings& volume : scene.volumes) {
        addShape(volume.shape);
        if (volume.grid) h.add(contentOf(volume.grid->path));
    }
    return h.finish();
}

bool OnceReporter::isNew(std::string_view module, std::string_view sentence) {
    const std::lock_guard lock(mutex_);
    return said_.insert(fmt::format("{} {}", module, sentence)).second;
}

void OnceReporter::info(std::string_view module, std::string_view sentence) {
    if (isNew(module, sentence)) to_.info(module, sentence);
}

void OnceReporter::warn(std::string_view module, std::string_view sentence) {
    if (isNew(module, sentence)) to_.warn(module, sentence);
}

void OnceReporter::progress(std::string_view phase, double fraction, double secondsLeft,
                            bool done) {
    to_.progress(phase, fraction, secondsLeft, done);
}

}  // namespace sss
