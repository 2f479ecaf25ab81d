// The energy convention in pictures: what a plane under an even sky shows, against the half-space's
// radiative transfer by adding-doubling, which knows nothing of profiles.
#include "sss/medium/half_space.h"
#include "sss/medium/single_scatter.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "unit/integrate/pass_maker.h"

#include <cmath>
#include <memory>
#include <variant>

namespace sss {
namespace {

using testing::SceneMaker;
using testing::value;

constexpr double kEta = 1.4;

/// alpha' of 0.985, 0.976 and 0.964, scattering forwards, evenly and backwards.
Medium threeMedia() {
    Medium medium;
    medium.sigmaA = {0.06, 0.1, 0.15};
    medium.g = {0.6, 0, -0.4};
    medium.sigmaS = DRgb(4) / (1.0 - medium.g);
    medium.eta = kEta;
    return medium;
}

class PlaneUnderAnEvenSky {
public:
    PlaneUnderAnEvenSky() {
        TranslucentMaterial material;
        material.medium = threeMedia();
        maker_.object(BoxShape{{14, 5, 14}}, maker_.material(material));
        maker_.light(EnvironmentLight{Rgb(1), {}, 0});
        maker_.scene.camera.lookAt = {0, 2.5, 0};
        maker_.scene.camera.up = {0, 0, 1};
        maker_.scene.camera.fovDegrees = 1;
        maker_.scene.film.width = maker_.scene.film.height = 2;
        maker_.scene.film.samples = 8192;
        maker_.scene.quality.bounces = 0;
        maker_.scene.quality.tolerance = 0.03;
        const World world = maker_.world();
        clouds_ = std::make_unique<testing::MadeClouds>(world, makeBodyOptics(world));
    }

    /// Radiance by diffusion and single scattering together at a cosine: by reciprocity the share
    /// that leaves, of light that falls in at it. Pass 1 knows nothing of the convention.
    DRgb seenAt(double cosine, EnergyConvention energy = EnergyConvention::Consistent) {
        std::get<TranslucentMaterial>(maker_.scene.materials[0].material).energy = energy;
        const double sine = std::sqrt(1 - cosine * cosine);
        maker_.scene.camera.position = {30 * sine, 2.5 + 30 * cosine, 0};
        const World world = maker_.world();
        const LayeredImage image = testing::renderFrom(
            world, makeBodyOptics(world), [&](std::size_t b) { return clouds_->clouds[b].view(); });
        DRgb sum(0);
        for (int i = 0; i < 4; ++i)
            for (int c = 0; c < 3; ++c)
                for (const char* layer : {"diffusion", "single"})
                    sum[c] += value(image, layer, i % 2, i / 2, c) / 4;
        return sum;
    }

    /// Of diffuse light: Gauss's three points in cosine^2.
    DRgb seenAround() {
        return 5.0 / 18.0 * (seenAt(std::sqrt(0.1127016654)) + seenAt(std::sqrt(0.8872983346))) +
               8.0 / 18.0 * seenAt(std::sqrt(0.5));
    }

private:
    SceneMaker maker_;
    std::unique_ptr<testing::MadeClouds> clouds_;
};

TEST(Energy, CachedPlanesReturnWhatRadiativeTransferReturns) {
    const double enters = 1 - fresnelReflectance(1.0, kEta);
    PlaneUnderAnEvenSky plane;
    const DRgb normal = plane.seenAt(1), diffuse = plane.seenAround();
    const DRgb added = plane.seenAt(1, EnergyConvention::Jensen);
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium medium = threeMedia().channel(c);
        const HalfSpaceTotals truth = halfSpaceTotals(medium);
        const double diffuseTruth = hemisphericalTransmittance(kEta) * truth.diffuse;
        EXPECT_NEAR(diffuse[c], diffuseTruth, 0.02 * diffuseTruth) << c;
        // The convention is made for diffuse light: along the normal diffusion returns the same and
        // single scattering its own, which a peak backwards makes too much.
        const double normalModel = truth.diffuse -
                                   singleScatterAlbedo(medium, Illumination::Diffuse) +
                                   singleScatterAlbedo(medium, Illumination::Normal);
        EXPECT_NEAR(normalModel, truth.normal, (medium.g < 0 ? 0.04 : 0.02) * truth.normal) << c;
        EXPECT_NEAR(normal[c], enters * normalModel, 0.01 * normalModel) << c;
        // Added as the papers do, by what is counted twice (or, forwards, what the dipole lacks).
        const double twice = makeProfile("dipole", medium)->total() +
                             singleScatterAlbedo(medium, Illumination::Diffuse) - truth.diffuse;
        EXPECT_NEAR(added[c] - normal[c], enters * twice, 2e-3) << c;
        EXPECT_TRUE(medium.g > 0 || twice > 0.05) << twice;
    }
}

}  // namespace
}  // namespace sss
