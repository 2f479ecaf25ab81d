#include "sss/medium/albedo_inversion.h"

#include "sss/base/error.h"
#include "sss/medium/half_space.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

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

double radiusOf(const ChannelMedium& m, RadiusKind kind) {
    if (kind == RadiusKind::VolumeMfp) return 1 / m.sigmaT();
    if (kind == RadiusKind::TransportMfp) return m.meanFreePathMm();
    return 1 / std::sqrt(3 * m.sigmaA * m.sigmaTPrime());
}

TEST(AlbedoInversion, RoundTripForEveryProfileAndRadius) {
    for (const char* name : {"dipole", "better_dipole", "normalized_diffusion",
                             "normalized_diffusion_perpendicular", "normalized_diffusion_dmfp"}) {
        for (const double eta : {0.8, 1.0, 1.3, 2.0}) {
            for (const double g : {-0.5, 0.0, 0.9}) {
                for (const double color : {0.0, 1e-6, 0.01, 0.3, 0.8, 0.99, 0.999}) {
                    for (const RadiusKind kind : {RadiusKind::VolumeMfp, RadiusKind::TransportMfp,
                                                  RadiusKind::DiffuseMfp}) {
                        const ChannelMedium m = invertAlbedo(name, {color, 1.0, kind, g, eta});
                        EXPECT_NEAR(makeProfile(name, m)->total(), color, 1e-6)
                            << name << " eta " << eta << " g " << g << " color " << color;
                        EXPECT_NEAR(radiusOf(m, kind), 1.0, 1e-12);
                    }
                }
            }
        }
    }
}

/// What an inversion refuses a color with.
std::string refusal(std::string_view profile, const DiffuseLook& look,
                    const ProfileOptions& options = {}) {
    try {
        invertAlbedo(profile, look, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "not refused";
}

TEST(AlbedoInversion, SlabsOfTheirOwnThickness) {
    ProfileOptions options;
    for (const double thickness : {0.5, 2.0, 1e3}) {
        options.slabThicknessMm = thickness;
        for (const RadiusKind kind :
             {RadiusKind::VolumeMfp, RadiusKind::TransportMfp, RadiusKind::DiffuseMfp}) {
            for (const double g : {0.0, 0.8}) {
                const auto clearSlab = [&](double sigmaS) {
                    return makeProfile("multipole", {0, sigmaS, g, 1.3}, options)->total();
                };
                for (const double color : {0.0, 1e-6, 0.01, 0.1, 0.5, 0.9, 0.99}) {
                    const DiffuseLook look{color, 1.0, kind, g, 1.3};
                    // Without absorption less comes back than that: sigma'_t is then 1, or 1 - g.
                    const double most =
                        clearSlab(kind == RadiusKind::VolumeMfp ? 1.0 : 1 / (1 - g));
                    if (kind != RadiusKind::DiffuseMfp && color > most) {
                        EXPECT_NE(refusal("multipole", look, options), "not refused");
                        continue;
                    }
                    const ChannelMedium m = invertAlbedo("multipole", look, options);
                    EXPECT_NEAR(makeProfile("multipole", m, options)->total(), color, 1e-6)
                        << thickness << " mm, color " << color << " g " << g;
                    EXPECT_NEAR(radiusOf(m, kind), 1.0, 1e-12);
                    EXPECT_EQ(invertAlbedo("multipole_transmittance", look, options), m);
                }
            }
        }
    }
    options.slabThicknessMm = 2;
    const double most = makeProfile("multipole", {0, 1, 0, 1.3}, options)->total();
    EXPECT_EQ(invertAlbedo("multipole", {most, 1.0}, options).sigmaA, 0.0);
    EXPECT_NE(refusal("multipole", {most + 1e-6, 1.0}, options).find("a slab of 2 mm"),
              std::string::npos);
}

// As much as it returns without absorption, down to nothing; the rest of the light is single
// scattering's.
TEST(AlbedoInversion, PhotonBeamUpToItsLimit) {
    for (const double eta : {0.75, 1.3}) {
        const double most = makeProfile("photon_beam", {0, 1, 0, eta})->total();
        EXPECT_TRUE(most > 0.93 && most < 0.99) << most;
        for (const double color : {1e-6, most - 1e-3, most - 1e-6, most}) {
            const ChannelMedium beam =
                invertAlbedo("photon_beam", {color, 2.0, RadiusKind::TransportMfp, 0, eta});
            EXPECT_NEAR(makeProfile("photon_beam", beam)->total(), color, 1e-6);
        }
    }
    const std::string words = refusal("photon_beam", {0.97, 2.0});
    EXPECT_NE(words.find("above 0.959644"), std::string::npos) << words;
    EXPECT_NE(words.find("single and multiple scattering"), std::string::npos) << words;
}

TEST(AlbedoInversion, SimulatedProfileReturnsTheColorItself) {
    ProfileOptions options;
    options.tabulatedError = 0.1;  // quick: the total does not depend on it
    options.tabulatedCacheFolder =
        std::filesystem::temp_directory_path() / ("sss_inversion_" + std::to_string(::getpid()));
    for (const double color : {0.0, 0.5, 0.999}) {
        const ChannelMedium m = invertAlbedo("tabulated", {color, 2.0}, options);
        EXPECT_NEAR(makeProfile("tabulated", m, options)->total(), color, 1e-6);
    }
    std::filesystem::remove_all(options.tabulatedCacheFolder);
}

TEST(AlbedoInversion, EndsAndImpossibleColors) {
    EXPECT_EQ(invertReducedAbsorption("dipole", 0.0, 0, 1.3), 1.0);
    EXPECT_EQ(invertReducedAbsorption("dipole", 1.0, 0, 1.3), 0.0);
    EXPECT_EQ(invertAlbedo("dipole", {1.0, 2.0}).sigmaA, 0.0);
    EXPECT_THROW(invertAlbedo("dipole", {1.0, 2.0, RadiusKind::DiffuseMfp}), Error);
    EXPECT_THROW(invertReducedAbsorption("dipole", 1.5, 0, 1.3), Error);
    EXPECT_THROW(invertReducedAbsorption("dipole", std::nan(""), 0, 1.3), Error);
    ProfileOptions papers;
    papers.boundary = BoundaryModel::Polynomial;
    const DiffuseLook beyond{0.5, 1, RadiusKind::TransportMfp, 0, 3};
    EXPECT_NE(refusal("better_dipole", beyond, papers).find("do not reach"), std::string::npos);
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
