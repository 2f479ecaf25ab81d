#include "sss/light/light_table.h"

#include "sss/light/directional_light.h"
#include "sss/light/environment_light.h"
#include "sss/light/point_light.h"
#include "sss/light/rectangle_light.h"
#include "sss/light/sphere_light.h"
#include "sss/light/spot_light.h"

namespace sss {
namespace {

struct Maker {
    const DVec3& origin;
    using Result = std::unique_ptr<Light>;

    Result operator()(const PointLight& s) const {
        return std::make_unique<PointLightSource>(s, origin);
    }
    Result operator()(const SpotLight& s) const {
        return std::make_unique<SpotLightSource>(s, origin);
    }
    Result operator()(const DirectionalLight& s) const {
        return std::make_unique<DirectionalLightSource>(s);
    }
    Result operator()(const RectangleLight& s) const {
        return std::make_unique<RectangleLightSource>(s, origin);
    }
    Result operator()(const SphereLight& s) const {
        return std::make_unique<SphereLightSource>(s, origin);
    }
    Result operator()(const EnvironmentLight& s) const { return makeEnvironment(s); }
};

}  // namespace

std::unique_ptr<Light> makeLight(const LightSettings& settings, const DVec3& originMm) {
    return std::visit(Maker{originMm}, settings);
}

}  // namespace sss
