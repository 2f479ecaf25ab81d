#include "sss/scene/scene_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

namespace sss {
namespace {

namespace fs = std::filesystem;

fs::path scenes() { return fs::path(SSS_SOURCE_DIR) / "scenes"; }

TEST(ShippedScenes, AreAllAccepted) {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(scenes())) {
        const fs::path file = entry.path();
        if (file.extension() != ".json" || file.filename() == "scene.schema.json") continue;
        EXPECT_NO_THROW(readScene(file)) << file;
        ++count;
    }
    EXPECT_GE(count, 7);
}

TEST(ShippedScenes, EveryFolderHasAReadme) {
    for (const auto& entry : fs::directory_iterator(scenes())) {
        if (!entry.is_directory()) continue;
        EXPECT_TRUE(fs::exists(entry.path() / "README.md")) << entry.path();
    }
}

/// All the lengths of a scene, in mm, in a fixed order.
std::vector<double> lengthsMm(const Scene& scene) {
    std::vector<double> out;
    const auto add = [&](const DVec3& p) { out.insert(out.end(), {p.x, p.y, p.z}); };
    add(scene.camera.position);
    add(scene.camera.lookAt);
    out.push_back(scene.camera.apertureRadiusMm);
    out.push_back(scene.camera.focusDistanceMm);
    out.push_back(std::get<SphereShape>(scene.objects.at(0).shape).radiusMm);
    out.push_back(std::get<RectangleShape>(scene.objects.at(1).shape).widthMm);
    out.push_back(std::get<RectangleShape>(scene.objects.at(1).shape).heightMm);
    for (const ObjectSettings& object : scene.objects) {
        for (const TransformStep& step : object.transform) {
            const DMat4& matrix = std::get<DMat4>(step);
            for (int column = 0; column < 4; ++column) add(DVec3(matrix[column]));
        }
    }
    const auto& lamp = std::get<RectangleLight>(scene.lights.at(0));
    add(lamp.centre);
    add(lamp.lookAt);
    out.push_back(lamp.widthMm);
    out.push_back(lamp.heightMm);
    add(std::get<PointLight>(scene.lights.at(1)).position);
    return out;
}

TEST(ShippedScenes, MillimetresCentimetresAndMetresAreOneScene) {
    const Scene mm = readScene(scenes() / "units/mm.json");
    const std::vector<double> expected = lengthsMm(mm);
    EXPECT_EQ(mm.camera.position, DVec3(0, 45, 90));
    EXPECT_EQ(std::get<SphereShape>(mm.objects.at(0).shape).radiusMm, 10);
    for (const char* name : {"units/cm.json", "units/m.json"}) {
        SCOPED_TRACE(name);
        const Scene other = readScene(scenes() / name);
        EXPECT_NE(other.metersPerUnit, mm.metersPerUnit);
        const std::vector<double> lengths = lengthsMm(other);
        ASSERT_EQ(lengths.size(), expected.size());
        for (std::size_t i = 0; i < lengths.size(); ++i) {
            EXPECT_NEAR(lengths[i], expected[i], 1e-12) << i;
        }
        EXPECT_EQ(std::get<TranslucentMaterial>(other.materials.at(0).material).medium,
                  std::get<TranslucentMaterial>(mm.materials.at(0).material).medium);
        EXPECT_EQ(std::get<RectangleLight>(other.lights.at(0)).radiance,
                  std::get<RectangleLight>(mm.lights.at(0)).radiance);
        EXPECT_EQ(std::get<PointLight>(other.lights.at(1)).intensity,
                  std::get<PointLight>(mm.lights.at(1)).intensity);
        EXPECT_EQ(other.film.width, mm.film.width);
        EXPECT_EQ(other.film.samples, mm.film.samples);
    }
}

void expectBunnySetup(const Scene& scene) {
    EXPECT_EQ(scene.metersPerUnit, 0.001);
    EXPECT_EQ(scene.camera.position, DVec3(0, 12, 130));
    EXPECT_EQ(scene.camera.lookAt, DVec3(0));
    EXPECT_EQ(scene.camera.up, DVec3(0, 1, 0));
    EXPECT_EQ(scene.camera.fovDegrees, 28);
    EXPECT_EQ(scene.camera.apertureRadiusMm, 0);
    EXPECT_EQ(scene.film.width, 512);
    EXPECT_EQ(scene.film.height, 512);
    EXPECT_EQ(scene.film.filter, FilterKind::Box);
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(std::get<MeshFileShape>(scene.objects[0].shape).path,
              "/usr/share/glmark2/models/bunny.obj");
    ASSERT_EQ(scene.objects[0].transform.size(), 1u);
    EXPECT_EQ(std::get<FitStep>(scene.objects[0].transform[0]).heightMm, 50);
    EXPECT_EQ(std::get<FitStep>(scene.objects[0].transform[0]).centre, DVec3(0));
    ASSERT_EQ(scene.lights.size(), 2u);
    const auto& lamp = std::get<RectangleLight>(scene.lights[0]);
    EXPECT_EQ(lamp.centre, DVec3(-120, 70, -50));
    EXPECT_EQ(lamp.lookAt, DVec3(0));
    EXPECT_EQ(lamp.widthMm, 120);
    EXPECT_EQ(lamp.heightMm, 120);
    EXPECT_EQ(lamp.radiance, Rgb(10));
    EXPECT_FALSE(lamp.twoSided);
    EXPECT_EQ(std::get<EnvironmentLight>(scene.lights[1]).radiance, Rgb(0.05f));
    EXPECT_TRUE(std::get<EnvironmentLight>(scene.lights[1]).map.empty());
}

// The scene on which the peers were measured, so that all can be compared.
TEST(ShippedScenes, BunnyIsTheSceneOfThePeers) {
    const Scene demo = readScene(scenes() / "bunny/demo.json");
    expectBunnySetup(demo);
    EXPECT_EQ(demo.film.samples, 64);
    EXPECT_EQ(demo.objects[0].normals, NormalsMode::Smooth);
    const auto& glossy = std::get<TranslucentMaterial>(demo.materials[0].material);
    EXPECT_EQ(glossy.mediumName, "Marble");
    EXPECT_TRUE(glossy.surfaceReflection && glossy.singleScattering);
    EXPECT_GT(glossy.roughness, 0);

    const Scene bunny = readScene(scenes() / "bunny/bunny.json");
    expectBunnySetup(bunny);
    EXPECT_EQ(bunny.film.samples, 16);
    EXPECT_EQ(bunny.quality.bounces, 0);
    EXPECT_EQ(bunny.objects[0].normals, NormalsMode::Flat);
    const auto& marble = std::get<TranslucentMaterial>(bunny.materials[0].material);
    EXPECT_EQ(marble.medium.sigmaS, DRgb(2.19, 2.62, 3.0));
    EXPECT_EQ(marble.medium.sigmaA, DRgb(0.0021, 0.0041, 0.0071));
    EXPECT_EQ(marble.medium.eta, 1.5);
    EXPECT_FALSE(marble.surfaceReflection || marble.singleScattering);
    EXPECT_TRUE(marble.multipleScattering);

    const Scene twin = readScene(scenes() / "bunny/lambertian.json");
    expectBunnySetup(twin);
    EXPECT_EQ(twin.film.samples, 16);
    EXPECT_EQ(twin.quality.bounces, 0);
    EXPECT_EQ(twin.objects[0].normals, NormalsMode::Flat);
    EXPECT_EQ(std::get<LambertianMaterial>(twin.materials[0].material).reflectance,
              Rgb(0.83f, 0.79f, 0.75f));
}

}  // namespace
}  // namespace sss
