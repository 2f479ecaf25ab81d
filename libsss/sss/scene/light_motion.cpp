#include "sss/scene/light_motion.h"

namespace sss {
namespace {

struct Mover {
    const RigidTransform& motion;

    LightSettings operator()(PointLight light) const {
        light.position = motion.transformPoint(light.position);
        return light;
    }
    LightSettings operator()(SpotLight light) const {
        light.position = motion.transformPoint(light.position);
        light.lookAt = motion.transformPoint(light.lookAt);
        return light;
    }
    LightSettings operator()(DirectionalLight light) const {
        light.direction = motion.transformDirection(light.direction);
        return light;
    }
    LightSettings operator()(RectangleLight light) const {
        light.centre = motion.transformPoint(light.centre);
        light.lookAt = motion.transformPoint(light.lookAt);
        light.up = motion.transformDirection(light.up);
        return light;
    }
    LightSettings operator()(SphereLight light) const {
        light.centre = motion.transformPoint(light.centre);
        return light;
    }
    LightSettings operator()(const EnvironmentLight& light) const { return light; }
};

}  // namespace

LightSettings movedLight(const LightSettings& light, const RigidTransform& motion) {
    return std::visit(Mover{motion}, light);
}

bool hasDirection(const EnvironmentLight& light) { return !light.map.empty(); }

}  // namespace sss
