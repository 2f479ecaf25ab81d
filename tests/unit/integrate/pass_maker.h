#pragma once
#include "sss/integrate/preprocess.h"
#include "sss/integrate/renderer.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

namespace sss::testing {

/// Pass 1 of all bodies of a world.
struct MadeClouds {
    std::vector<BodyCloud> clouds;
    std::vector<BodyReport> reports;

    MadeClouds(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics) {
        SilentReporter silent;
        make(world, optics, silent);
    }
    MadeClouds(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
               Reporter& reporter) {
        make(world, optics, reporter);
    }

private:
    void make(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
              Reporter& reporter) {
        for (int b = 0; b < static_cast<int>(world.bodies().size()); ++b) {
            BodyReport& report = reports.emplace_back();
            if (optics[static_cast<std::size_t>(b)]->inDiffuseLimit) {
                clouds.emplace_back();
                continue;
            }
            const SurfaceSamples samples =
                placePoints(world, b, *optics[static_cast<std::size_t>(b)], {}, reporter, report);
            IrradianceResult light = lightPoints(world, b, samples, optics, reporter, report);
            clouds.push_back(buildCloud(samples, std::move(light.irradiance), report));
            if (optics[static_cast<std::size_t>(b)]->onShape)
                clouds.back().solved = shapeSolution(world, b, samples, light.beams, optics,
                                                     clouds.back().view(), reporter, report);
        }
    }
};

/// Pass 2 from clouds, `view(body)` each.
template <typename View>
RenderResult resultFrom(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                        const View& view) {
    std::vector<std::unique_ptr<BodyField>> fields;
    for (std::size_t b = 0; b < world.bodies().size(); ++b)
        fields.push_back(optics[b]->inDiffuseLimit
                             ? nullptr
                             : std::make_unique<BodyField>(world.bodies()[b], *optics[b], view(b),
                                                           world.scene().quality.tolerance));
    SilentReporter silent;
    RenderResult result = render(world, optics, fields, silent);
    EXPECT_EQ(result.dropped.samples, 0u);
    return result;
}

template <typename View>
LayeredImage renderFrom(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                        const View& view) {
    return std::move(resultFrom(world, optics, view).image);
}

/// Both passes.
inline LayeredImage picture(const Scene& scene) {
    SilentReporter silent;
    const World world(scene, silent);
    const auto optics = makeBodyOptics(world);
    const MadeClouds made(world, optics);
    return renderFrom(world, optics, [&](std::size_t b) { return made.clouds[b].view(); });
}

/// One channel of a pixel of a layer ("" is the beauty).
inline double value(const LayeredImage& image, const char* layer, int x, int y, int channel) {
    const ImageLayer* found = image.find(layer);
    if (!found) {
        ADD_FAILURE() << "no layer " << layer;
        return 0;
    }
    const auto pixel = static_cast<std::size_t>(y * image.width + x);
    return static_cast<double>(
        found->values[pixel * found->channels.size() + static_cast<std::size_t>(channel)]);
}

}  // namespace sss::testing
