#include "sss/integrate/half_space_single.h"

#include "sss/medium/single_scatter.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "support/directions.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::direction;

// Lit from everywhere and by the normal, by quadrature: what leaves in all.
TEST(HalfSpaceSingle, SumsToTheSingleScatterAlbedo) {
    for (const double eta : {1.0, 1.35}) {
        TranslucentMaterial material = testing::grey(0, 0, eta);
        material.medium.sigmaA = {0.1, 1, 3};
        material.medium.sigmaS = {5, 2, 1};
        material.medium.g = {0.7, 0, -0.4};
        const MediumCoefficients medium(material.medium);
        const auto leaving = [&](int channel, double muI, int azimuths) {
            return testing::integrate01(64, [&](double muO) {
                return testing::integrate01(azimuths, [&](double turn) {
                    const Rgb f = halfSpaceSingleScattering(medium, static_cast<float>(eta),
                                                            direction(muO, 2 * kPi * turn),
                                                            direction(muI, 0));
                    return 2 * kPi * muO * static_cast<double>(f[channel]);
                });
            });
        };
        const double diffuseIn = hemisphericalTransmittance(eta);
        for (int c = 0; c < 3; ++c) {
            const ChannelMedium channel = material.medium.channel(c);
            const double diffuse =
                testing::integrate01(64, [&](double muI) { return 2 * muI * leaving(c, muI, 48); });
            const double expected = diffuseIn * singleScatterAlbedo(channel, Illumination::Diffuse);
            EXPECT_NEAR(diffuse, expected, 2e-3 * expected) << eta << ' ' << c;
            const double normalIn = 1 - fresnelReflectance(1.0, eta);
            const double normal = normalIn * singleScatterAlbedo(channel, Illumination::Normal);
            EXPECT_NEAR(leaving(c, 1, 1), normal, 2e-3 * normal) << eta << ' ' << c;
        }
    }
}

TEST(HalfSpaceSingle, IsReciprocal) {
    const MediumCoefficients medium(testing::grey(1, 2, 1.4).medium);
    const Vec3 a = direction(0.9, 1), b = direction(0.2, 3);
    const float there = halfSpaceSingleScattering(medium, 1.4f, a, b).y;
    EXPECT_GT(there, 0);
    EXPECT_NEAR(halfSpaceSingleScattering(medium, 1.4f, b, a).y, there, 1e-5f * there);
    EXPECT_EQ(halfSpaceSingleScattering(medium, 1.4f, a, {b.x, b.y, -b.z}), Rgb(0));
}

}  // namespace
}  // namespace sss
