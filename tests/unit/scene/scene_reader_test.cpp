#include "sss/scene/scene_reader.h"

#include "sss/base/error.h"
#include "unit/scene/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace sss {
namespace {

TEST(SceneReader, GivesDefaultsToWhatIsNotWritten) {
    const Scene scene = read({});
    EXPECT_EQ(scene.file, "/scenes/here/test.json");
    EXPECT_EQ(scene.metersPerUnit, 0.001);
    EXPECT_EQ(scene.camera.lookAt, DVec3(0));
    EXPECT_EQ(scene.camera.up, DVec3(0, 1, 0));
    EXPECT_EQ(scene.camera.fovDegrees, 40);
    EXPECT_EQ(scene.camera.apertureRadiusMm, 0);
    EXPECT_EQ(scene.camera.focusDistanceMm, 0);
    EXPECT_EQ(scene.film.width, 512);
    EXPECT_EQ(scene.film.height, 512);
    EXPECT_EQ(scene.film.samples, 64);
    EXPECT_EQ(scene.film.filter, FilterKind::BlackmanHarris);
    EXPECT_EQ(scene.film.layers,
              (std::vector<std::string>{"diffusion", "single", "surface", "albedo", "N", "Z"}));
    EXPECT_TRUE(scene.film.halfPrecision);
    EXPECT_EQ(scene.quality.tolerance, 0.01);
    EXPECT_EQ(scene.quality.bounces, 4);
    EXPECT_EQ(scene.quality.seed, 0u);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(translucent(scene).profile, "dipole");
    EXPECT_EQ(translucent(scene).roughness, 0);
    EXPECT_TRUE(translucent(scene).surfaceReflection);
    EXPECT_TRUE(translucent(scene).singleScattering);
    EXPECT_TRUE(translucent(scene).multipleScattering);
    const ObjectSettings& ball = scene.objects.at(0);
    EXPECT_EQ(ball.name, "sphere");
    EXPECT_EQ(ball.normals, NormalsMode::Auto);
    EXPECT_TRUE(ball.group.empty() && ball.transform.empty());
    EXPECT_EQ(ball.line, 1);
    EXPECT_GT(ball.column, 1);
}

TEST(SceneReader, ReadsCameraFilmAndQuality) {
    const Scene scene =
        read({.units = "0.01",
              .camera = R"({"position": [1, 2, 3], "lookAt": [4, 5, 6], "up": [0, 0, 2],
                       "fovDegrees": 25.5, "apertureRadius": 0.5, "focusDistance": 7})",
              .rest = R"(, "film": {"width": 3, "height": 4, "samples": 5, "filter": "tent",
                       "filterRadius": 1.5, "layers": ["Z", "N"], "exposureStops": -1.5,
                       "precision": "float"},
                     "quality": {"tolerance": 0.5, "spacingMm": 0.25, "irradianceSamples": 9,
                       "bounces": 0, "seed": 9007199254740991,
                       "integrator": "volume"},
                     "comment": "x", "$schema": "y")"});
    EXPECT_EQ(scene.camera.position, DVec3(10, 20, 30));
    EXPECT_EQ(scene.camera.lookAt, DVec3(40, 50, 60));
    EXPECT_EQ(scene.camera.up, DVec3(0, 0, 2));
    EXPECT_EQ(scene.camera.fovDegrees, 25.5);
    EXPECT_EQ(scene.camera.apertureRadiusMm, 5);
    EXPECT_EQ(scene.camera.focusDistanceMm, 70);
    EXPECT_EQ(scene.film.width, 3);
    EXPECT_EQ(scene.film.height, 4);
    EXPECT_EQ(scene.film.samples, 5);
    EXPECT_EQ(scene.film.filter, FilterKind::Tent);
    EXPECT_EQ(scene.film.filterRadiusPixels, 1.5);
    EXPECT_EQ(scene.film.layers, (std::vector<std::string>{"Z", "N"}));
    EXPECT_EQ(scene.film.exposureStops, -1.5);
    EXPECT_FALSE(scene.film.halfPrecision);
    EXPECT_EQ(scene.quality.tolerance, 0.5);
    EXPECT_EQ(scene.quality.spacingMm, 0.25);  // mm whatever the unit
    EXPECT_EQ(scene.quality.irradianceSamples, 9);
    EXPECT_EQ(scene.quality.bounces, 0);
    EXPECT_EQ(scene.quality.seed, 9007199254740991u);
    EXPECT_EQ(scene.quality.integrator, "volume");
    EXPECT_GT(scene.quality.integratorLine, 0);
}

TEST(SceneReader, ReadsEveryFilterName) {
    const std::pair<const char*, FilterKind> filters[] = {
        {"box", FilterKind::Box},
        {"tent", FilterKind::Tent},
        {"gaussian", FilterKind::Gaussian},
        {"blackman-harris", FilterKind::BlackmanHarris}};
    for (const auto& [name, kind] : filters) {
        const std::string film = fmt::format(R"(, "film": {{"filter": "{}"}})", name);
        EXPECT_EQ(read({.rest = film}).film.filter, kind) << name;
    }
}

TEST(SceneReader, TurnsAnUngivenUpAsideForAVerticalView) {
    const Scene scene = read({.camera = R"({"position": [0, 50, 0]})"});
    EXPECT_EQ(scene.camera.up, DVec3(0, 0, 1));
    EXPECT_NE(complaint({.camera = R"({"position": [0, 50, 0], "up": [0, 1, 0]})"})
                  .find("along the line of sight"),
              std::string::npos);
}

TEST(SceneReader, ConvertsLengthsButNotMedia) {
    const Parts parts{
        .units = "0.01",
        .materials = R"("wax": {"type": "translucent", "sigmaAPerMm": [0.1, 0.2, 0.3],
                                "sigmaSPerMm": 2, "g": [0.5, 0, -0.5], "eta": 1.4,
                                "roughness": 0.25, "profile": "better_dipole",
                                "boundary": "polynomial", "surfaceReflection": false,
                                "singleScattering": false, "multipleScattering": false})",
        .objects = R"({"shape": "box", "size": [1, 2, 3], "material": "wax", "group": "g"},
                      {"shape": "rectangle", "width": 4, "height": 5, "material": "wax"},
                      {"shape": "disk", "radius": 6, "material": "wax", "normals": "flat"},
                      {"shape": "cylinder", "radius": 7, "height": 8, "material": "wax"},
                      {"shape": "sphere", "radius": 9, "material": "wax", "normals": "smooth"})"};
    const Scene scene = read(parts);
    const TranslucentMaterial& wax = translucent(scene);
    EXPECT_EQ(wax.medium.sigmaA, DRgb(0.1, 0.2, 0.3));
    EXPECT_EQ(wax.medium.sigmaS, DRgb(2));
    EXPECT_EQ(wax.medium.g, DRgb(0.5, 0, -0.5));
    EXPECT_EQ(wax.medium.eta, 1.4);
    EXPECT_EQ(wax.mediumName, "");
    EXPECT_EQ(wax.roughness, 0.25);
    EXPECT_EQ(wax.profile, "better_dipole");
    EXPECT_EQ(wax.profileOptions.boundary, BoundaryModel::Polynomial);
    EXPECT_FALSE(wax.surfaceReflection || wax.singleScattering || wax.multipleScattering);
    EXPECT_EQ(std::get<BoxShape>(scene.objects[0].shape).sizeMm, DVec3(10, 20, 30));
    EXPECT_EQ(scene.objects[0].group, "g");
    const auto& rectangle = std::get<RectangleShape>(scene.objects[1].shape);
    EXPECT_EQ(rectangle.widthMm, 40);
    EXPECT_EQ(rectangle.heightMm, 50);
    EXPECT_EQ(std::get<DiskShape>(scene.objects[2].shape).radiusMm, 60);
    EXPECT_EQ(scene.objects[2].normals, NormalsMode::Flat);
    const auto& cylinder = std::get<CylinderShape>(scene.objects[3].shape);
    EXPECT_EQ(cylinder.radiusMm, 70);
    EXPECT_EQ(cylinder.heightMm, 80);
    EXPECT_EQ(std::get<SphereShape>(scene.objects[4].shape).radiusMm, 90);
    EXPECT_EQ(scene.objects[4].normals, NormalsMode::Smooth);
}

TEST(SceneReader, ReadsMaterialsWhereverTheyStand) {
    const Scene scene = readSceneText(
        R"({"objects": [{"material": "b", "radius": 2, "shape": "sphere"}],
            "camera": {"position": [0, 0, 9]},
            "materials": {"a": {"reflectance": 1, "type": "lambertian"},
                          "b": {"medium": "Cream", "type": "translucent"}},
            "metersPerUnit": 1})",
        "x.json");
    EXPECT_EQ(scene.objects.at(0).material, 1);
    EXPECT_EQ(std::get<SphereShape>(scene.objects[0].shape).radiusMm, 2000);
    EXPECT_EQ(scene.camera.position.z, 9000);
}

TEST(SceneReader, LetsTheCallerOverruleTheUnit) {
    const Scene scene = read({.units = "0.001"}, 0.01);
    EXPECT_EQ(scene.metersPerUnit, 0.01);
    EXPECT_EQ(scene.camera.position.z, 1000);
    const std::string unitless =
        R"({"camera": {"position": [0, 0, 9]}, "materials": {"a": {"type": "lambertian",
            "reflectance": 1}}, "objects": [{"shape": "sphere", "radius": 2, "material": "a"}]})";
    EXPECT_EQ(readSceneText(unitless, "x.json", 1.0).camera.position.z, 9000);
    EXPECT_THROW(readSceneText(unitless, "x.json"), Error);
    for (const double bad : {0.0, -1.0, 1e7, std::numeric_limits<double>::quiet_NaN()}) {
        try {
            readSceneText(unitless, "x.json", bad);
            ADD_FAILURE() << "accepted " << bad;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()),
                      fmt::format("x.json: metersPerUnit is given as {}; it must be from 1e-09 to "
                                  "1000000",
                                  bad));
        }
    }
}

TEST(SceneReader, AcceptsTheBoundsThatAreInAndNotThoseThatAreOut) {
    const auto quality = [](std::string_view text) {
        return complaint({.rest = fmt::format(R"(, "quality": {{{}}})", text)});
    };
    EXPECT_EQ(quality(R"("tolerance": 0.5, "spacingMm": 1e-9, "bounces": 64)"), "no error");
    EXPECT_NE(quality(R"("tolerance": 0)"), "no error");
    EXPECT_NE(quality(R"("spacingMm": 9e-10)"), "no error");
    EXPECT_NE(quality(R"("bounces": 65)"), "no error");
    const auto wax = [](std::string_view text) {
        return complaint({.materials = fmt::format(
                              R"("milk": {{"type": "translucent", "sigmaAPerMm": 0,
                                  "sigmaSPerMm": 1e9, {}}})",
                              text)});
    };
    EXPECT_EQ(wax(R"("g": -0.999, "eta": 0.1, "roughness": 1)"), "no error");
    EXPECT_NE(wax(R"("g": -1)"), "no error");
    EXPECT_NE(wax(R"("eta": 10.001)"), "no error");
    EXPECT_NE(wax(R"("roughness": -1e-300)"), "no error");
}

TEST(SceneReader, ShortensAndEscapesWhatItQuotes) {
    const std::string what = complaint(
        {.materials = "\"milk\": {\"type\": \"\\u001b[31m" + std::string(500, 'x') + "\"}"});
    EXPECT_NE(what.find("\\u001b[31mxxx"), std::string::npos) << what;
    EXPECT_LT(what.size(), 300u);
}

}  // namespace
}  // namespace sss
