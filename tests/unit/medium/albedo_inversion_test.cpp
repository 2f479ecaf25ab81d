#include "sss/medium/albedo_inversion.h"

#include "sss/base/error.h"
#include "sss/medium/half_space.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace sss;

namespace {

TEST(AlbedoInversion, TableOfTheGeometryCases) {
    // Columns of geometry-cases.md, with the polynomials it was made with.
    ProfileOptions papers;
    papers.boundary = BoundaryModel::Polynomial;
    const auto at = [&](double color, double eta) {
        return invertReducedAbsorption("dipole", color, 0, eta, papers);
    };
    EXPECT_NEAR(at(0.01, 1.3), 0.89718223, 5e-9);
    EXPECT_NEAR(at(0.5, 1.3), 0.027418075, 5e-10);
    EXPECT_NEAR(at(0.999, 1.3), 4.4630004e-8, 5e-15);
    EXPECT_NEAR(at(0.9, 1.5), 0.00029425011, 5e-12);
    EXPECT_NEAR(1 - invertReducedAbsorption("better_dipole", 0.5, 0, 1.3, papers), 0.97556418146694,
                1e-12);
}

TEST(AlbedoInversion, RoundTripForEveryProfileAndRadius) {
    for (const char* name :
         {"dipole", "better_dipole", "normalized_diffusion", "normalized_diffusion_perpendicular",
          "normalized_diffusion_dmfp", "multipole"}) {
        for (const double eta : {0.8, 1.0, 1.3, 2.0}) {
            for (const double g : {-0.5, 0.0, 0.9}) {
                for (const double color : {0.0, 1e-6, 0.01, 0.3, 0.8, 0.99, 0.999}) {
                    for (const RadiusKind kind : {RadiusKind::VolumeMfp, RadiusKind::TransportMfp,
                                                  RadiusKind::DiffuseMfp}) {
                        ProfileOptions options;
                        // The slab's thickness in the inversion's units is fixed: only the
                        // transport mean free path of 1 mm keeps it.
                        options.slabThicknessMm = 1e6;
                        if (std::string(name) == "multipole" && kind != RadiusKind::TransportMfp) {
                            continue;
                        }
                        const ChannelMedium m =
                            invertAlbedo(name, {color, 1.0, kind, g, eta}, options);
                        EXPECT_NEAR(makeProfile(name, m, options)->total(), color, 1e-6)
                            << name << " eta " << eta << " g " << g << " color " << color;
                        const double radius = kind == RadiusKind::VolumeMfp ? 1 / m.sigmaT()
                                              : kind == RadiusKind::TransportMfp
                                                  ? m.meanFreePathMm()
                                                  : 1 / std::sqrt(3 * m.sigmaA * m.sigmaTPrime());
                        EXPECT_NEAR(radius, 1.0, 1e-12);
                    }
                }
            }
        }
    }
}

TEST(AlbedoInversion, BeamAndSimulatedProfiles) {
    for (const double color : {1e-6, 0.6, 0.9}) {
        const ChannelMedium beam = invertAlbedo("photon_beam", {color, 2.0});
        EXPECT_NEAR(makeProfile("photon_beam", beam)->total(), color, 1e-6);
    }
    for (const double color : {0.01, 0.6, 0.999}) {
        const ChannelMedium exact = invertAlbedo("tabulated", {color, 2.0});
        EXPECT_NEAR(halfSpaceTotals(exact).diffuse, color, 1e-6);
    }
}

TEST(AlbedoInversion, EndsAndImpossibleColors) {
    EXPECT_EQ(invertReducedAbsorption("dipole", 0.0, 0, 1.3), 1.0);
    EXPECT_EQ(invertReducedAbsorption("dipole", 1.0, 0, 1.3), 0.0);
    EXPECT_EQ(invertAlbedo("dipole", {1.0, 2.0}).sigmaA, 0.0);
    EXPECT_THROW(invertAlbedo("dipole", {1.0, 2.0, RadiusKind::DiffuseMfp}), Error);
    EXPECT_THROW(invertReducedAbsorption("dipole", 1.5, 0, 1.3), Error);
    EXPECT_THROW(invertReducedAbsorption("dipole", std::nan(""), 0, 1.3), Error);
    EXPECT_THROW(invertReducedAbsorption("photon_beam", 0.9999, 0, 1.3), Error);
}

TEST(AlbedoInversion, OpenPbrAndPrincipledNames) {
    OpenPbrSubsurface look;
    look.color = {0.8, 0.5, 0.2};
    look.radius = 0.002;  // scene in metres
    look.anisotropy = 0.4;
    const Medium medium = mediumFromOpenPbr(look, 1000);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(makeProfile("dipole", medium.channel(c))->total(), look.color[c], 1e-6);
        EXPECT_NEAR(1 / medium.channel(c).sigmaT(), 2.0 * look.radiusScale[c], 1e-12);
    }
    EXPECT_EQ(medium.g, DRgb(0.4));
    EXPECT_EQ(medium.eta, 1.5);

    const PrincipledSubsurface skin{{0.8, 0.5, 0.4}};
    const Medium principled = mediumFromPrincipled(skin, 1000);
    EXPECT_NEAR(1 / principled.channel(0).sigmaT(), 5.0, 1e-12);  // 5 mm, Blender's default
    EXPECT_NEAR(1 / principled.channel(1).sigmaT(), 1.0, 1e-12);
    EXPECT_EQ(principled.eta, 1.4);
}

TEST(AlbedoInversion, OpenPbrsOwnAlbedoIsNearTheExactOneWithoutBoundary) {
    for (const double color : {0.3, 0.8}) {
        const double exact = 1 - invertReducedAbsorption("tabulated", color, 0, 1);
        EXPECT_NEAR(openPbrAlbedo(color, 0), exact, 0.005);
    }
}

}  // namespace
