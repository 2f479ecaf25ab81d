#include "stage.h"

#include "sss/base/error.h"
#include "sss/scene/scene_reader.h"

namespace sss::bench {

Stage::Stage(const Scene& scene) : world_(scene, reporter_), optics_(makeBodyOptics(world_)) {
    if (world_.bodies().size() != 1)
        throw Error(ErrorKind::BadInput, scene.file.string(),
                    "has " + std::to_string(world_.bodies().size()) + " translucent bodies",
                    "the bench measures scenes with one");
}

Stage::Made Stage::makeCloud() const {
    Made made;
    SilentReporter silent;
    SurfaceSamples samples =
        placePoints(world_, 0, optics(), {.mostPoints = 100'000'000}, silent, made.report);
    IrradianceResult light = lightPoints(world_, 0, samples, optics_, silent, made.report);
    made.cloud = buildCloud(std::move(samples), std::move(light.irradiance), made.report);
    return made;
}

Scene readScene(const std::filesystem::path& file, const Quality& quality) {
    Scene scene = sss::readScene(file);
    if (quality.spacingMm > 0) scene.quality.spacingMm = quality.spacingMm;
    if (quality.tolerance > 0) scene.quality.tolerance = quality.tolerance;
    if (quality.irradianceSamples > 0) scene.quality.irradianceSamples = quality.irradianceSamples;
    if (quality.seed > 0) scene.quality.seed = quality.seed;
    return scene;
}

}  // namespace sss::bench
