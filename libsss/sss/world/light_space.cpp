// The space in which pass 1 computes: World's members that speak of it.
#include "sss/geom/rounding.h"
#include "sss/scene/light_motion.h"
#include "sss/world/world.h"

#include <algorithm>

namespace sss {
namespace {

DMat4 matrixOf(const RigidTransform& t) {
    DMat4 m(t.rotation);
    m[3] = {t.translation, 1.0};
    return m;
}

struct RoundingCutter {
    void operator()(PointLight& light) const { light.position = withoutRounding(light.position); }
    void operator()(SpotLight& light) const {
        light.position = withoutRounding(light.position);
        light.lookAt = withoutRounding(light.lookAt);
    }
    void operator()(DirectionalLight& light) const {
        light.direction = withoutRounding(light.direction);
    }
    void operator()(RectangleLight& light) const {
        light.centre = withoutRounding(light.centre);
        light.lookAt = withoutRounding(light.lookAt);
        light.up = withoutRounding(light.up);
    }
    void operator()(SphereLight& light) const { light.centre = withoutRounding(light.centre); }
    void operator()(EnvironmentLight&) const {}
};

}  // namespace

RigidTransform World::lightFromScene() const {
    if (bodies_.empty()) return {};
    RigidTransform sceneFromBody = bodies_.front().worldFromBody;
    sceneFromBody.translation += originMm_;
    const bool isOriented = std::ranges::any_of(scene_.lights, [](const LightSettings& light) {
        const auto* environment = std::get_if<EnvironmentLight>(&light);
        return environment != nullptr && hasDirection(*environment);
    });
    if (isOriented) sceneFromBody.rotation = DMat3(1.0);
    return sceneFromBody.inverse();
}

DMat4 World::lightFromObject(std::size_t object) const {
    const DMat4 exact = matrixOf(lightFromScene()) * loaded_[object].worldFromObject;
    DMat4 m(withoutRounding(DMat3(exact)));
    m[3] = {withoutRounding(DVec3(exact[3])), 1.0};
    return m;
}

LightSettings World::lightInLightSpace(std::size_t light) const {
    LightSettings moved = movedLight(scene_.lights[light], lightFromScene());
    std::visit(RoundingCutter{}, moved);
    return moved;
}

std::unique_ptr<const World> World::inLightSpace() const {
    Scene scene = scene_;
    std::vector<LoadedObject> loaded = loaded_;
    for (std::size_t k = 0; k < loaded.size(); ++k) loaded[k].worldFromObject = lightFromObject(k);
    for (std::size_t k = 0; k < scene.lights.size(); ++k) scene.lights[k] = lightInLightSpace(k);
    for (VolumeSettings& volume : scene.volumes)
        volume.transform.emplace_back(matrixOf(lightFromScene()));
    SilentReporter silent;
    return std::unique_ptr<const World>(new World(std::move(scene), std::move(loaded), silent));
}

}  // namespace sss
