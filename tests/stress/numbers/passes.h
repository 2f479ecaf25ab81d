#pragma once
#include "sss/integrate/body_field.h"
#include "sss/integrate/preprocess.h"
#include "unit/integrate/scene_maker.h"

#include <memory>
#include <vector>

namespace sss::stress {

/// A scene made ready for both passes, without a picture; every body by its points.
class Passes {
public:
    /// Throws Error as the programs do.
    explicit Passes(const Scene& scene) : world_(scene, silent_), optics_(makeBodyOptics(world_)) {
        for (int b = 0; b < static_cast<int>(world_.bodies().size()); ++b) {
            const auto index = static_cast<std::size_t>(b);
            BodyReport& report = reports_.emplace_back();
            const SurfaceSamples samples =
                placePoints(world_, b, *optics_[index], {}, silent_, report);
            IrradianceResult light = lightPoints(world_, b, samples, optics_, silent_, report);
            BodyCloud& cloud =
                clouds_.emplace_back(buildCloud(samples, std::move(light.irradiance), report));
            if (optics_[index]->onShape)
                cloud.solved = shapeSolution(world_, b, samples, light.beams, optics_, cloud.view(),
                                             silent_, report);
        }
    }
    const World& world() const { return world_; }
    std::span<const std::unique_ptr<BodyOptics>> optics() const { return optics_; }
    const std::vector<BodyCloud>& clouds() const { return clouds_; }
    const std::vector<BodyReport>& reports() const { return reports_; }

    /// Fields over the clouds, one a body.
    std::vector<std::unique_ptr<BodyField>> fields() const {
        std::vector<std::unique_ptr<BodyField>> made;
        for (std::size_t b = 0; b < clouds_.size(); ++b)
            made.push_back(std::make_unique<BodyField>(world_.bodies()[b], *optics_[b],
                                                       clouds_[b].view(),
                                                       world_.scene().quality.tolerance));
        return made;
    }
    /// Exitance at `count` places of the first body, spread over its faces.
    std::vector<Rgb> exitance(std::size_t count) const {
        const auto made = fields();
        const std::size_t faces = world_.bodies()[0].mesh.faceCount();
        std::vector<Rgb> values;
        for (std::size_t i = 0; i < count; ++i) {
            const auto face = static_cast<FaceIndex>(i * faces / count);
            const float u = 0.1f + 0.1f * static_cast<float>(i % 5);
            values.push_back(made[0]->exitance(face, Vec2(u, 0.6f - u)));
        }
        return values;
    }

private:
    SilentReporter silent_;
    World world_;
    std::vector<std::unique_ptr<BodyOptics>> optics_;
    std::vector<BodyCloud> clouds_;
    std::vector<BodyReport> reports_;
};

/// One body lit from one side, with few points and samples; diffusion by the profile, or solved on
/// the shape.
inline testing::SceneMaker bodyScene(Shape shape, const Medium& medium, bool onShape = false) {
    testing::SceneMaker maker;
    TranslucentMaterial material;
    material.medium = medium;
    material.onShape = onShape;
    maker.object(std::move(shape), maker.material(material));
    maker.light(DirectionalLight{{0, -1, -1}, Rgb(1)});
    maker.scene.camera.position = {0, 0, 1e8};
    maker.scene.quality.tolerance = 0.1;
    maker.scene.quality.irradianceSamples = 4;
    maker.scene.quality.bounces = 0;
    return maker;
}

}  // namespace sss::stress
