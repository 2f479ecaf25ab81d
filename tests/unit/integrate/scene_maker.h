#pragma once
#include "sss/medium/measured_media.h"
#include "sss/scene/scene.h"
#include "sss/world/world.h"

#include <string>
#include <utility>
#include <vector>

namespace sss::testing {

/// Builds scenes in memory, in mm. Objects and materials are named by their number.
struct SceneMaker {
    Scene scene;

    SceneMaker() {
        scene.file = "test.json";
        scene.film.width = scene.film.height = 16;
        scene.film.samples = 4;
        scene.film.filter = FilterKind::Box;
        scene.film.layers = {"diffusion", "single", "surface", "albedo", "N", "Z"};
        scene.quality.tolerance = 0.05;
    }
    int material(Material m) {
        scene.materials.push_back({"m" + std::to_string(scene.materials.size()), std::move(m)});
        return static_cast<int>(scene.materials.size()) - 1;
    }
    ObjectSettings& object(Shape shape, int material, const DMat4& placed = DMat4(1.0)) {
        ObjectSettings o;
        o.name = "o" + std::to_string(scene.objects.size());
        o.shape = std::move(shape);
        o.material = material;
        o.line = static_cast<int>(scene.objects.size()) + 1;
        o.column = 7;
        o.transform = {placed};
        scene.objects.push_back(std::move(o));
        return scene.objects.back();
    }
    SceneMaker& light(LightSettings l) {
        scene.lights.push_back(std::move(l));
        return *this;
    }
    World world() const {
        SilentReporter silent;
        return World(scene, silent);
    }
};

inline DMat4 moved(const DVec3& by) { return glm::translate(DMat4(1.0), by); }
inline DMat4 turned(double degrees, const DVec3& axis) {
    return glm::rotate(DMat4(1.0), glm::radians(degrees), axis);
}

inline TranslucentMaterial measured(std::string_view name) {
    TranslucentMaterial m;
    m.medium = toMedium(*findMeasuredMedium(name));
    m.mediumName = std::string(name);
    return m;
}

/// The same in all channels.
inline TranslucentMaterial grey(double sigmaA, double sigmaS, double eta) {
    TranslucentMaterial m;
    m.medium.sigmaA = DRgb(sigmaA);
    m.medium.sigmaS = DRgb(sigmaS);
    m.medium.eta = eta;
    return m;
}

/// Midpoint rule over [0, 1].
template <typename F>
double integrate01(int steps, const F& f) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += f((i + 0.5) / steps);
    return sum / steps;
}

}  // namespace sss::testing
