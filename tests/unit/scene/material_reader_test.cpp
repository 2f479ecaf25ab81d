#include "sss/base/error.h"
#include "sss/medium/half_space.h"
#include "sss/medium/measured_media.h"
#include "sss/scene/material_override.h"
#include "sss/scene/metal_table.h"
#include "unit/scene/scene_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sss {
namespace {

TEST(MaterialReader, ReadsReducedScattering) {
    const Scene scene = read({.materials = R"("milk": {"type": "translucent", "sigmaAPerMm": 0,
        "sigmaSPrimePerMm": [1, 2, 3], "g": [0.5, 0.9, 0]})"});
    EXPECT_EQ(translucent(scene).medium.eta, 1.3);
    for (int c = 0; c < 3; ++c) {
        EXPECT_DOUBLE_EQ(translucent(scene).medium.channel(c).sigmaSPrime(), c + 1.0);
    }
    EXPECT_DOUBLE_EQ(translucent(scene).medium.sigmaS.y, 20.0);
}

TEST(MaterialReader, FindsTheMediumOfAColourAndAMeanFreePath) {
    for (const std::string_view profile : {"dipole", "better_dipole"}) {
        SCOPED_TRACE(profile);
        const std::string look = fmt::format(
            R"("type": "translucent", "profile": "{}", "eta": 1.4, "g": [0, 0.5, 0.9],
               "diffuseColor": [0.9, 0.5, 0.1])",
            profile);
        const Scene transport = read(
            {.units = "0.01",
             .materials = fmt::format(R"("milk": {{{}, "meanFreePathMm": [2, 1, 0.5]}})", look)});
        const Scene diffuse =
            read({.units = "0.01",
                  .materials = fmt::format(
                      R"("milk": {{{}, "diffuseMeanFreePathMm": [2, 1, 0.5]}})", look)});
        const DRgb colour(0.9, 0.5, 0.1), lengthMm(2, 1, 0.5);
        for (int c = 0; c < 3; ++c) {
            const ChannelMedium a = translucent(transport).medium.channel(c);
            EXPECT_NEAR(a.meanFreePathMm(), lengthMm[c], 1e-9);  // mm, whatever the unit
            EXPECT_NEAR(makeProfile(profile, a)->total(), colour[c], 1e-6);
            const ChannelMedium b = translucent(diffuse).medium.channel(c);
            const double sigmaTr = std::sqrt(3 * b.sigmaA * b.sigmaTPrime());
            EXPECT_NEAR(1 / sigmaTr, lengthMm[c], 1e-9);
            EXPECT_NEAR(makeProfile(profile, b)->total(), colour[c], 1e-6);
        }
    }
}

TEST(MaterialReader, TakesTheColourOfASlabForItsOwnThickness) {
    const std::string look = R"("type": "translucent", "meanFreePathMm": 2, "slabThicknessMm": 3)";
    const auto sheet = [&](const std::string& more) {
        return read({.materials = "\"milk\": {" + look + ", " + more + "}"});
    };
    const std::string colour = R"("diffuseColor": 0.3, "profile": )";
    const Scene lit = sheet(colour + R"("multipole")");
    const TranslucentMaterial& milk = translucent(lit);
    EXPECT_EQ(milk.profileOptions.slabThicknessMm, 3.0);
    const auto profile = makeProfile("multipole", milk.medium.channel(0), milk.profileOptions);
    EXPECT_NEAR(profile->total(), 0.3, 1e-6);
    EXPECT_EQ(translucent(sheet(colour + R"("multipole_transmittance")")).medium, milk.medium);
    // More than it can return, with the rest passing through.
    try {
        sheet(R"("diffuseColor": 0.7, "profile": "multipole")");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("a slab of 3 mm"), std::string::npos);
    }
}

// The beam itself returns 0.96 at most: with single scattering every colour can be had.
TEST(MaterialReader, TakesTheColourOfAPhotonBeamWithSingleScattering) {
    const std::string look = R"("milk": {"type": "translucent", "diffuseColor": 0.999,
        "meanFreePathMm": 2, "profile": "photon_beam")";
    const Scene scene = read({.materials = look + "}"});
    const ChannelMedium medium = translucent(scene).medium.channel(0);
    EXPECT_NEAR(halfSpaceTotals(medium).diffuse, 0.999, 1e-6);
    EXPECT_THROW(read({.materials = look + R"(, "singleScattering": false})"}), Error);
    EXPECT_THROW(read({.materials = look + R"(, "energy": "jensen"})"}), Error);
}

TEST(MaterialReader, ReadsTheNamesOfOpenPbrInSceneUnits) {
    const Scene scene = read({.units = "0.01", .materials = R"("milk": {"type": "translucent",
        "subsurface_color": [0.9, 0.5, 0.1], "subsurface_radius": 0.2,
        "subsurface_scatter_anisotropy": 0.5, "specular_roughness": 0.3})"});
    const TranslucentMaterial& milk = translucent(scene);
    EXPECT_EQ(milk.roughness, 0.3);
    EXPECT_EQ(milk.medium.eta, 1.5);
    EXPECT_EQ(milk.medium.g, DRgb(0.5));
    EXPECT_EQ(milk.diffuseColor, DRgb(0.9, 0.5, 0.1));
    const DRgb pathMm(2, 1, 0.5);  // 0.2 units of 10 mm, scaled by 1, 1/2, 1/4
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium channel = milk.medium.channel(c);
        EXPECT_NEAR(1 / channel.sigmaT(), pathMm[c], 1e-9);
        EXPECT_NEAR(makeProfile("dipole", channel)->total(), (*milk.diffuseColor)[c], 1e-6);
    }
}

TEST(MaterialReader, ReadsTheNamesOfThePrincipledShaderInSceneUnits) {
    const Scene scene = read({.units = "1", .materials = R"("milk": {"type": "translucent",
        "profile": "better_dipole", "boundary": "polynomial", "base_color": 0.6,
        "subsurface_ior": 1.3, "roughness": 0.4})"});
    const TranslucentMaterial& milk = translucent(scene);
    EXPECT_EQ(milk.roughness, 0.4);
    const DRgb pathMm(5, 1, 0.5);  // Blender's defaults: 5 mm of red in a scene in metres
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium channel = milk.medium.channel(c);
        EXPECT_NEAR(1 / channel.sigmaT(), pathMm[c], 1e-9);
        EXPECT_NEAR(makeProfile("better_dipole", channel, milk.profileOptions)->total(), 0.6, 1e-6);
    }
}

TEST(MaterialReader, BoundariesAreAsRoughAsTheNamesUsedHaveThem) {
    const auto roughness = [](const std::string& look) {
        return translucent(read({.materials = R"("milk": {"type": "translucent", )" + look + "}"}))
            .roughness;
    };
    EXPECT_EQ(roughness(R"("medium": "Marble")"), 0.0);
    EXPECT_EQ(roughness(R"("subsurface_color": 0.5)"), 0.3);
    EXPECT_EQ(roughness(R"("subsurface_color": 0.5, "specular_roughness": 0)"), 0.0);
    EXPECT_EQ(roughness(R"("roughness": 0.1, "subsurface_color": 0.5)"), 0.1);
    EXPECT_EQ(roughness(R"("base_color": 0.5)"), 0.5);
    EXPECT_EQ(roughness(R"("base_color": 0.5, "roughness": 0)"), 0.0);
}

TEST(MaterialReader, ReadsTheEnergyConvention) {
    EXPECT_EQ(translucent(read({})).energy, EnergyConvention::Consistent);
    const std::string look = R"("milk": {"type": "translucent", "medium": "Marble", "energy": )";
    EXPECT_EQ(translucent(read({.materials = look + R"("consistent"})"})).energy,
              EnergyConvention::Consistent);
    EXPECT_EQ(translucent(read({.materials = look + R"("jensen"})"})).energy,
              EnergyConvention::Jensen);
    EXPECT_FALSE(translucent(read({})).diffuseColor.has_value());
}

TEST(BoundaryOverride, ReachesEveryTranslucentMaterial) {
    Scene scene = read({.materials = std::string(kMilk) + R"(,
        "paint": {"type": "lambertian", "reflectance": 0.5})"});
    setBoundary(scene, boundaryModel("polynomial", "--boundary"));
    EXPECT_EQ(translucent(scene).profileOptions.boundary, BoundaryModel::Polynomial);
    setBoundary(scene, boundaryModel("exact", "--boundary"));
    EXPECT_EQ(translucent(scene).profileOptions.boundary, BoundaryModel::Exact);
    EXPECT_THROW(boundaryModel("polinomial", "--boundary"), Error);
}

TEST(ModelOverride, RefusesWhatIsNoModelOfAWholeScene) {
    Scene scene = read({});
    for (const char* name : {"multipole", "dipol"}) {
        try {
            setModel(scene, name, "--model");
            ADD_FAILURE() << name << " was accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Usage);
            const std::string start = std::string("--model: there is no model of diffusion \"") +
                                      name + "\" for a whole scene; ";
            EXPECT_EQ(std::string(error.what()).substr(0, start.size()), start);
        }
    }
}

TEST(MaterialReader, ReadsEveryMeasuredMedium) {
    for (const MeasuredMedium& measured : measuredMedia()) {
        const Scene scene =
            read({.materials = fmt::format(R"("milk": {{"type": "translucent", "medium": "{}"}})",
                                           measured.name)});
        EXPECT_EQ(translucent(scene).medium, toMedium(measured));
        EXPECT_EQ(translucent(scene).mediumName, measured.name);
    }
    const Scene other =
        read({.materials = R"("milk": {"type": "translucent", "medium": "Marble", "eta": 1.2})"});
    Medium expected = toMedium(*findMeasuredMedium("Marble"));
    expected.eta = 1.2;
    EXPECT_EQ(translucent(other).medium, expected);
}

TEST(MaterialReader, ReadsOpaqueMaterials) {
    const Scene scene = read({.materials = std::string(kMilk) + R"(,
        "paint": {"type": "lambertian", "reflectance": [0.1, 0.2, 0.3]},
        "ring": {"type": "metal", "metal": "gold", "roughness": 0.5},
        "other": {"type": "metal", "eta": 1.5, "k": [1, 2, 3]},
        "lamp": {"type": "emitter", "radiance": 5, "twoSided": true})"});
    ASSERT_EQ(scene.materials.size(), 5u);
    EXPECT_EQ(scene.materials[1].name, "paint");
    EXPECT_EQ(std::get<LambertianMaterial>(scene.materials[1].material).reflectance,
              Rgb(0.1f, 0.2f, 0.3f));
    const auto& ring = std::get<MetalMaterial>(scene.materials[2].material);
    EXPECT_EQ(ring.eta, Rgb(0.188f, 0.424f, 1.383f));
    EXPECT_EQ(ring.k, Rgb(3.403f, 2.472f, 1.915f));
    EXPECT_EQ(ring.roughness, 0.5);
    const auto& other = std::get<MetalMaterial>(scene.materials[3].material);
    EXPECT_EQ(other.eta, Rgb(1.5f));
    EXPECT_EQ(other.k, Rgb(1, 2, 3));
    const auto& lamp = std::get<EmitterMaterial>(scene.materials[4].material);
    EXPECT_EQ(lamp.radiance, Rgb(5));
    EXPECT_TRUE(lamp.twoSided);
}

TEST(MetalTable, HasTheReflectancesOfTheMetals) {
    // Normal reflectance ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2) at red and blue, as polished
    // metals look: silver and aluminium white, gold and copper lose their blue.
    const auto reflectance = [](std::string_view name, int c) {
        for (const MetalKind& metal : metalTable()) {
            if (metal.name != name) continue;
            const double n = metal.eta[c], k = metal.k[c];
            return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
        }
        ADD_FAILURE() << name;
        return 0.0;
    };
    EXPECT_NEAR(reflectance("silver", 0), 0.99, 0.02);
    EXPECT_NEAR(reflectance("silver", 2), 0.97, 0.02);
    EXPECT_NEAR(reflectance("aluminium", 0), 0.91, 0.02);
    EXPECT_NEAR(reflectance("aluminium", 2), 0.92, 0.02);
    EXPECT_NEAR(reflectance("gold", 0), 0.94, 0.02);
    EXPECT_NEAR(reflectance("gold", 2), 0.39, 0.02);
    EXPECT_NEAR(reflectance("copper", 0), 0.92, 0.02);
    EXPECT_NEAR(reflectance("copper", 2), 0.54, 0.02);
    EXPECT_NEAR(reflectance("iron", 1), 0.52, 0.04);
    EXPECT_NEAR(reflectance("chromium", 1), 0.57, 0.02);
}

}  // namespace
}  // namespace sss
