// What is not computed because it brings nothing, or is known already.
#include "sss/integrate/body_optics.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::grey;
using testing::measured;

// The same coefficients through a different profile object: a channel apart by the last bit.
TranslucentMaterial nearlyGrey(const TranslucentMaterial& material) {
    TranslucentMaterial apart = material;
    apart.medium.sigmaA.y = std::nextafter(apart.medium.sigmaA.x, 1.0);
    apart.medium.sigmaA.z = std::nextafter(apart.medium.sigmaA.y, 1.0);
    return apart;
}

TEST(EqualChannels, AreKnownByTheirCoefficients) {
    EXPECT_EQ(BodyOptics(measured("Marble")).equalChannels(), 0);
    const TranslucentMaterial material = grey(0.1, 2, 1.3);
    const BodyOptics all(material);
    EXPECT_EQ(all.equalChannels(), 2);
    EXPECT_EQ(all.profiles[0], all.profiles[2]);
    TranslucentMaterial two = material;
    two.medium.sigmaS.y = 1;  // red and blue are left alike
    const BodyOptics pair(two);
    EXPECT_EQ(pair.equalChannels(), 1);
    EXPECT_EQ(pair.firstLike(1), 1);
    EXPECT_EQ(pair.firstLike(2), 0);
    const TranslucentMaterial none = nearlyGrey(material);
    EXPECT_EQ(BodyOptics(none).equalChannels(), 0);
}

// Tables, spacing and energy of a shared profile are those of three profiles of their own.
TEST(EqualChannels, ChangeNothing) {
    for (const char* profile : {"dipole", "normalized_diffusion"}) {
        TranslucentMaterial material = grey(0.1, 2, 1.3), apart = nearlyGrey(material);
        material.profile = apart.profile = profile;
        const BodyOptics shared(material), own(apart);
        EXPECT_NEAR(spacingFor(shared, 0.01).spacingMm / spacingFor(own, 0.01).spacingMm, 1, 1e-9);
        EXPECT_NEAR(expectedQuadratureError(shared, 0.2) / expectedQuadratureError(own, 0.2), 1,
                    1e-9);
        const KernelTable a(shared.profilePointers(), 20, 0.1), b(own.profilePointers(), 20, 0.1);
        ASSERT_EQ(a.rowCount(), b.rowCount());
        for (float r = 0; r < 20; r += 0.37f) {
            const Rgb value = a.evaluate(r * r);
            EXPECT_EQ(value.x, value.y);
            EXPECT_EQ(value.x, value.z);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(value[c], b.evaluate(r * r)[c], 1e-6f * value[c]) << r;
                for (int k = 0; k < 4; ++k) {
                    const float bound = a.boundsAt(r * r).derivative[k][c];
                    EXPECT_NEAR(bound, b.boundsAt(r * r).derivative[k][c], 1e-4f * bound) << r;
                }
            }
        }
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(shared.multipleScale[c], shared.multipleScale.x);
            EXPECT_NEAR(shared.multipleScale[c], own.multipleScale[c], 1e-6f);
        }
    }
}

// Media alike may have been made from colours that are not: as much is taken off each.
TEST(EqualChannels, KeepTheColoursTheyShow) {
    TranslucentMaterial material = grey(0.1, 2, 1.3);
    material.diffuseColor = DRgb(0.6, 0.6, 0.5);
    const BodyOptics optics(material);
    EXPECT_EQ(optics.equalChannels(), 2);
    EXPECT_EQ(optics.multipleScale.x, optics.multipleScale.y);
    EXPECT_LT(optics.multipleScale.z, optics.multipleScale.x);
}

}  // namespace
}  // namespace sss
