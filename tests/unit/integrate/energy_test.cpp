// The energy convention in pictures: what a plane under an even sky shows, against the half-space's
// radiative transfer by adding-doubling, which knows nothing of profiles.
#include "sss/medium/half_space.h"
#include "sss/medium/single_scatter.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "unit/integrate/pass_maker.h"

#include <array>

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
    PlaneUnderAnEvenSky(const char* profile, EnergyConvention energy) {
        TranslucentMaterial material;
        material.medium = threeMedia();
        material.profile = profile;
        material.energy = energy;
        maker_.object(BoxShape{{14, 5, 14}}, maker_.material(material));
        maker_.light(EnvironmentLight{Rgb(1), {}, 0});
        maker_.scene.camera.lookAt = {0, 2.5, 0};
        maker_.scene.camera.fovDegrees = 1;
        maker_.scene.film.width = maker_.scene.film.height = 2;
        maker_.scene.film.samples = 1024;
        maker_.scene.quality.bounces = 0;
        maker_.scene.quality.tolerance = 0.01;
        const World world = maker_.world();
        const auto optics = makeBodyOptics(world);
        clouds_ = std::make_unique<testing::MadeClouds>(world, optics);
    }

    /// Radiance by diffusion and single scattering together at a cosine: by reciprocity the share
    /// that leaves, of light that falls in at it.
    DRgb seenAt(double cosine) {
        const double sine = std::sqrt(1 - cosine * cosine);
        maker_.scene.camera.position = {30 * sine, 2.5 + 30 * cosine, 0};
        maker_.scene.camera.up = {0, 0, 1};
        const World world = maker_.world();
        const auto optics = makeBodyOptics(world);
        const LayeredImage image = testing::renderFrom(
            world, optics, [&](std::size_t b) { return clouds_->clouds[b].view(); });
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
    for (const char* profile : {"dipole", "photon_beam"}) {
        PlaneUnderAnEvenSky plane(profile, EnergyConvention::Consistent);
        const DRgb normal = plane.seenAt(1), diffuse = plane.seenAround();
        for (int c = 0; c < 3; ++c) {
            const HalfSpaceTotals truth = halfSpaceTotals(threeMedia().channel(c));
            EXPECT_NEAR(normal[c], enters * truth.normal, 0.02 * truth.normal) << profile << c;
            EXPECT_NEAR(diffuse[c], hemisphericalTransmittance(kEta) * truth.diffuse,
                        0.02 * truth.diffuse)
                << profile << c;
        }
    }
}

TEST(Energy, JensensSumIsBrighterByWhatIsCountedTwice) {
    PlaneUnderAnEvenSky consistent("dipole", EnergyConvention::Consistent);
    PlaneUnderAnEvenSky added("dipole", EnergyConvention::Jensen);
    const DRgb more = added.seenAt(1) - consistent.seenAt(1);
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium medium = threeMedia().channel(c);
        const double twice = makeProfile("dipole", medium)->total() +
                             singleScatterAlbedo(medium, Illumination::Diffuse) -
                             halfSpaceTotals(medium).diffuse;
        const double expected = (1 - fresnelReflectance(1.0, kEta)) * twice;
        EXPECT_NEAR(more[c], expected, 0.003) << c;
        std::printf("more %g %g\n", more[c], expected);
    }
}

}  // namespace
}  // namespace sss
