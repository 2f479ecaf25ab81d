// Diffusion on the shape, from the light that enters to whole pictures.
#include "sss/base/error.h"
#include "sss/geom/shapes.h"
#include "sss/integrate/cloud_cache.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "support/temporary_folder.h"
#include "unit/integrate/cache_maker.h"
#include "unit/integrate/pass_maker.h"

#include <fmt/ostream.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <mutex>
#include <numeric>

namespace sss {
namespace {

using testing::grey;
using testing::MadeClouds;
using testing::SceneMaker;
using testing::TemporaryFolder;

TranslucentMaterial onShape(TranslucentMaterial material) {
    material.onShape = true;
    return material;
}

// A ball under a sky of radiance 1, as a camera far away sees it.
SceneMaker ballUnderSky(const TranslucentMaterial& material, double radius) {
    SceneMaker maker;
    maker.object(SphereShape{radius}, maker.material(material));
    maker.light(EnvironmentLight{Rgb(1), {}, 0});
    maker.scene.camera.position = {0, 0, 30 * radius};
    maker.scene.camera.lookAt = {0, 0, 0};
    maker.scene.camera.fovDegrees = 2.6;  // within the ball's outline
    maker.scene.film.samples = 256;
    maker.scene.quality.tolerance = 0.02;
    return maker;
}

DRgb meanOf(const LayeredImage& image) {
    DRgb sum{0};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) sum[c] += testing::value(image, "", x, y, c);
    return sum / static_cast<double>(image.width * image.height);
}

// Without absorption, what is reflected, scattered once or more often, and seen straight through
// add up to the sky, however thin the ball.
TEST(Shape, WhiteFurnace) {
    for (const double radius : {0.5, 2.0, 8.0})
        for (const bool single : {false, true}) {
            TranslucentMaterial white = onShape(grey(0, 1, 1.4));
            white.singleScattering = single;
            const DRgb seen = meanOf(testing::picture(ballUnderSky(white, radius).scene));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(seen[c], 1, 0.015) << radius << (single ? " single" : "");
        }
}

// Two balls of one body that see each other, where they are closest: what goes from one to the
// other is counted once, by single scattering too.
TEST(Shape, WhiteFurnaceOfABodyThatSeesItself) {
    const double radius = 2;
    SceneMaker maker = ballUnderSky(onShape(grey(0, 1, 1.4)), radius);
    maker.scene.objects.front().group = "pair";
    maker.object(SphereShape{radius}, 0, testing::moved({2.1 * radius, 0, 0})).group = "pair";
    maker.scene.quality.bounces = 6;
    maker.scene.camera.lookAt = {0.6 * radius, 0, 0};
    maker.scene.camera.fovDegrees = 1;
    // There the light that enters is noisy: a picture is good to 1.1 %, these together to half.
    constexpr std::uint64_t kPictures = 4;
    maker.scene.film.samples = 64;
    DRgb seen{0};
    for (std::uint64_t k = 0; k < kPictures; ++k) {
        maker.scene.quality.seed = k;
        seen += meanOf(testing::picture(maker.scene)) / static_cast<double>(kPictures);
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], 1, 0.015);
}

// The solution is a phase of its own, ended once, and its report says what took how long.
TEST(Shape, TellsHowFarItIs) {
    struct Listener final : Reporter {
        void info(std::string_view, std::string_view) override {}
        void warn(std::string_view, std::string_view) override {}
        void progress(std::string_view phase, double fraction, double, bool done) override {
            const std::scoped_lock lock(mutex);
            if (phase != "shape") return;
            most = std::max(most, fraction);
            ends += done;
        }
        std::mutex mutex;
        double most = 0;
        int ends = 0;
    } listener;
    SceneMaker maker;
    maker.object(SphereShape{2}, maker.material(onShape(grey(0.01, 2, 1.3))));
    maker.light(EnvironmentLight{Rgb(1), {}, 0});
    maker.scene.quality.spacingMm = 0.4;
    const World world = maker.world();
    const auto optics = makeBodyOptics(world);
    const MadeClouds made(world, optics, listener);
    EXPECT_EQ(listener.most, 1);
    EXPECT_EQ(listener.ends, 1);
    const ShapeExitance& shape = *made.reports[0].shape;
    EXPECT_GT(shape.singleSeconds, 0);
    EXPECT_GT(shape.report.sourceSeconds, 0);
    EXPECT_GT(shape.report.solveSeconds, 0);
}

// What leaves a ball in sunlight leans away from where it entered. Radiant intensity in units of
// its mean over all directions, at two cosines of the angle to the sun: by 1.6e7 paths of a program
// of its own that knows balls only, mean over +-0.05 of the cosine, +-0.15 %. Leaving as from a
// Lambertian surface, the one would be 10 % darker and the other 4 % brighter.
TEST(Shape, LightLeansAwayFromWhereItEntered) {
    const double radius = 5, distance = 60 * radius, eta = 1.3;
    TranslucentMaterial material = onShape(grey(0.0021, 0.9979, eta));
    material.surfaceReflection = material.singleScattering = false;
    SceneMaker maker;
    maker.object(SphereShape{radius}, maker.material(material));
    maker.light(DirectionalLight{{0, 0, -1}, Rgb(1)});
    maker.scene.quality.tolerance = 0.02;
    maker.scene.film.samples = 64;
    const double half = 1.05 * radius;  // of the picture, at the ball
    maker.scene.camera.fovDegrees = 2 * std::atan(half / distance) * 180 / kPi;
    const double entered = kPi * radius * radius * hemisphericalTransmittance(eta);
    for (const auto& [cosine, intensity] : {std::pair{-0.55, 0.6113}, std::pair{0.55, 1.3286}}) {
        const double sine = std::sqrt(1 - cosine * cosine);
        maker.scene.camera.position = distance * DVec3(0, sine, cosine);
        const double seen = meanOf(testing::picture(maker.scene)).x * 4 * half * half;
        EXPECT_NEAR(seen * 4 * kPi / entered / intensity, 1, 0.02) << cosine;
    }
}

// What comes straight through a thin ball is the same whether what it scatters is shown or not.
TEST(Shape, IsSeenThroughWithoutWhatItScatters) {
    double through[2];
    for (const bool multiple : {false, true}) {
        TranslucentMaterial white = onShape(grey(0, 1, 1.4));
        white.singleScattering = white.surfaceReflection = false;
        white.multipleScattering = multiple;
        SceneMaker maker = ballUnderSky(white, 0.5);
        maker.scene.film.samples = 16;
        const LayeredImage seen = testing::picture(maker.scene);
        double sum = 0;
        for (int y = 0; y < seen.height; ++y)
            for (int x = 0; x < seen.width; ++x) sum += testing::value(seen, "surface", x, y, 0);
        through[multiple] = sum / (seen.width * seen.height);
    }
    EXPECT_GT(through[0], 0.3);
    EXPECT_EQ(through[0], through[1]);
}

// A plate of 0.8 mean free paths over a lamp: what has scattered and leaves its unlit face straight
// on, aslant and near the edge, its lit face, and its rim, along which light goes far. Radiance by
// `volume`, 16384 samples of each of 16 x 16 pixels, +-0.2 %, +-0.4 % at the rim.
TEST(Shape, ThinPlatesSendLightOutOfTheirRims) {
    struct View {
        DVec3 from, at;
        double half;  // of the picture, mm
        double radiance, within;
    };
    constexpr double kThickness = 0.8;
    for (const View& view : {View{{0, 0, 66}, {0, 0, 0}, 2, 0.0889, 0.035},
                             View{{0, 52, 30}, {0, 0, 0}, 1, 0.1030, 0.035},
                             View{{0, 0, 66}, {5, 0, 0}, 0.7, 0.0753, 0.11},
                             View{{0, 53, -40}, {0, 0, -kThickness / 2}, 1, 0.1067, 0.025},
                             View{{66, 0, 0}, {6, 0, 0}, 0.35 * kThickness, 0.1374, 0.1}}) {
        SceneMaker maker;
        TranslucentMaterial material = onShape(grey(0.002, 0.998, 1.3));
        material.surfaceReflection = false;
        material.singleScattering = true;
        maker.object(BoxShape{{12, 12, kThickness}}, maker.material(material));
        RectangleLight lamp;
        lamp.centre = {0, 0, -30};
        lamp.widthMm = lamp.heightMm = 40;
        maker.light(lamp);
        maker.scene.quality.tolerance = 0.01;
        maker.scene.quality.bounces = 0;
        maker.scene.film.samples = 64;
        CameraSettings& camera = maker.scene.camera;
        camera.position = view.from;
        camera.lookAt = view.at;
        camera.up = view.from.y > 0 ? DVec3(0, 0, 1) : DVec3(0, 1, 0);
        camera.fovDegrees =
            2 * std::atan(view.half / glm::distance(view.from, view.at)) * 180 / kPi;
        const LayeredImage seen = testing::picture(maker.scene);
        double scattered = 0;
        for (int y = 0; y < seen.height; ++y)
            for (int x = 0; x < seen.width; ++x)
                for (const char* layer : {"diffusion", "single"})
                    scattered += testing::value(seen, layer, x, y, 0) / (seen.width * seen.height);
        EXPECT_NEAR(scattered / view.radiance, 1, view.within) << view.from.x << " " << view.from.y;
    }
}

// A ball in sunlight, with its points and beams.
struct LitBall {
    SceneMaker maker;
    std::unique_ptr<World> world;
    std::vector<std::unique_ptr<BodyOptics>> optics;
    BodyCloud cloud;
    EnteredBeams beams;

    LitBall(const TranslucentMaterial& material, const DVec3& sun) {
        maker.object(SphereShape{5}, maker.material(material),
                     testing::moved({3, 1, -2}) * testing::turned(40, {1, 1, 0}));
        maker.light(DirectionalLight{sun, Rgb(2)});
        maker.scene.quality.spacingMm = 0.5;
        SilentReporter silent;
        world = std::make_unique<World>(maker.scene, silent);
        optics = makeBodyOptics(*world);
        BodyReport report;
        const SurfaceSamples samples = placePoints(*world, 0, *optics[0], {}, silent, report);
        IrradianceResult light = lightPoints(*world, 0, samples, optics, silent, report);
        cloud = buildCloud(samples, std::move(light.irradiance), report);
        beams = std::move(light.beams);
        // The cloud's points stand in the order of its octree; beams follow the samples.
        order = samples.points;
    }
    std::vector<SurfacePoint> order;
};

// In sunlight all of a point's beams are the sun's direction, refracted.
TEST(EnteredBeams, AreTheRefractedSun) {
    const double eta = 1.4;
    const DVec3 sun = glm::normalize(DVec3(0.3, -1, 0.2));
    const LitBall ball(onShape(grey(0.1, 2, eta)), sun);
    const RigidTransform bodyFromWorld = ball.world->bodies()[0].worldFromBody.inverse();
    const DVec3 inBody = bodyFromWorld.transformDirection(sun);
    ASSERT_EQ(ball.beams.directions.size(), ball.order.size() * EnteredBeams::kPerPoint);
    int lit = 0;
    for (std::size_t p = 0; p < ball.order.size(); ++p) {
        const DVec3 normal = glm::normalize(DVec3(ball.order[p].position));
        const double cosine = -glm::dot(inBody, normal);
        if (cosine < 0.1) continue;  // its cell may reach into the shadow
        ++lit;
        const double inside = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
        const DVec3 refracted = (inBody + cosine * normal) / eta - inside * normal;
        // Each beam is of one place in the cell, 0.5 mm across on a ball of 5 mm.
        for (const std::uint32_t beam : ball.beams.of(p))
            ASSERT_GT(glm::dot(DVec3(decodeUnitVector(beam)), refracted), std::cos(0.1));
    }
    EXPECT_GT(lit, 100);
}

// All light that enters scatters, is absorbed where it would have scattered, or leaves.
TEST(BeamSources, KeepTheLight) {
    for (const double albedo : {0.5, 1.0})
        for (const double extinction : {0.05, 0.4, 5.0}) {
            const LitBall ball(onShape(grey((1 - albedo) * extinction, albedo * extinction, 1.3)),
                               {0, -1, 0});
            const Medium& medium = ball.optics[0]->material.medium;
            const DiffusionConstants constants =
                diffusionConstants(medium, exactFresnelMoments(medium.eta));
            const BeamSources light =
                placeBeamSources(*ball.world, 0, ball.cloud.view(), ball.beams, constants);
            ASSERT_GT(light.entered[0], 0);
            EXPECT_NEAR((light.scattered[0] / albedo + light.unscattered[0]) / light.entered[0], 1,
                        3e-4)
                << albedo << ' ' << extinction;
            double sum = 0;
            for (const VolumeSource& s : light.sources) {
                sum += double{s.power.x};
                ASSERT_LT(glm::length(s.position), 5.001f);
            }
            EXPECT_NEAR(sum / light.scattered[0], 1, 1e-5);
        }
}

Scene twoBalls() {
    SceneMaker maker;
    maker.object(SphereShape{3}, maker.material(onShape(testing::measured("Marble"))));
    maker.object(SphereShape{2}, maker.material(testing::measured("Skimmilk")),
                 testing::moved({5, 0, 0}));
    maker.light(DirectionalLight{{-1, -1, -1}, Rgb(2)});
    maker.scene.camera.position = {2, 3, 20};
    maker.scene.quality.spacingMm = 0.4;
    return maker.scene;
}

// The correction goes through the cache: the picture from the file is that of the memory.
TEST(ShapeCache, GivesTheSamePicture) {
    const TemporaryFolder folder;
    SilentReporter silent;
    const World world(twoBalls(), silent);
    const auto optics = makeBodyOptics(world);
    const MadeClouds made(world, optics);
    EXPECT_FALSE(made.clouds[0].solved.empty());
    EXPECT_TRUE(made.clouds[1].solved.empty());
    testing::writeCache(folder / "c.sss", world, optics, made.clouds, made.reports);
    const bool through = optics[0]->seesThrough;
    const LayeredImage direct =
        testing::renderFrom(world, optics, [&](std::size_t b) { return made.clouds[b].view(); });
    const auto fresh = makeBodyOptics(world);
    const CloudCache cache(folder / "c.sss", world, fresh);
    EXPECT_EQ(fresh[0]->seesThrough, through);
    const LayeredImage fromFile =
        testing::renderFrom(world, fresh, [&](std::size_t b) { return cache.view(b); });
    ASSERT_EQ(fromFile.layers.size(), direct.layers.size());
    for (std::size_t l = 0; l < direct.layers.size(); ++l)
        EXPECT_EQ(fromFile.layers[l].values, direct.layers[l].values) << direct.layers[l].name;
}

// A cache that was made for the profile knows nothing of the shape.
TEST(ShapeCache, OfTheProfileIsRefused) {
    const TemporaryFolder folder;
    SilentReporter silent;
    Scene flat = twoBalls();
    for (NamedMaterial& m : flat.materials)
        std::get<TranslucentMaterial>(m.material).onShape = false;
    const World before(flat, silent);
    const auto flatOptics = makeBodyOptics(before);
    const MadeClouds made(before, flatOptics);
    testing::writeCache(folder / "c.sss", before, flatOptics, made.clouds, made.reports);
    const World world(twoBalls(), silent);
    const auto optics = makeBodyOptics(world);
    try {
        const CloudCache cache(folder / "c.sss", world, optics);
        FAIL() << "taken";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("model of diffusion"), std::string::npos) << e.what();
    }
}

// Lit evenly from all sides, of what enters leave, per channel: `leaves` scattered, `straight` not.
struct Leaving {
    DRgb leaves{0}, straight{0};
    explicit Leaving(const Scene& scene) {
        SilentReporter silent;
        const World world(scene, silent);
        const auto optics = makeBodyOptics(world);
        const MadeClouds made(world, optics);
        const ShapeExitance& shape = made.reports.at(0).shape.value();
        leaves = shape.leaves + shape.single;
        straight = shape.unscattered;
    }
};

// Radiative transfer by an independent Monte Carlo, standard error 0.0003: uniform Lambertian
// light, exitance over transmitted light, green.
TEST(Shape, BallsMatchRadiativeTransfer) {
    struct Known {
        const char* medium;
        double radiusMm, leaves;
    };
    for (const Known& known : {Known{"Marble", 1, 0.9865}, Known{"Marble", 10, 0.8956},
                               Known{"Skimmilk", 1, 0.9940}, Known{"Skimmilk", 10, 0.9454}}) {
        SceneMaker maker = ballUnderSky(onShape(testing::measured(known.medium)), known.radiusMm);
        maker.scene.quality.tolerance = 0.1;
        const Leaving ball(maker.scene);
        EXPECT_NEAR((ball.leaves.y + ball.straight.y) / known.leaves, 1, 0.02)
            << known.medium << ' ' << known.radiusMm;
    }
}

void writeObj(const std::filesystem::path& path, std::span<const TriangleMesh> meshes) {
    std::ofstream file(path);
    std::uint32_t first = 1;
    for (const TriangleMesh& mesh : meshes) {
        for (const DVec3& p : mesh.positions) fmt::print(file, "v {} {} {}\n", p.x, p.y, p.z);
        for (const UVec3& f : mesh.faces)
            fmt::print(file, "f {} {} {}\n", f.x + first, f.y + first, f.z + first);
        first += static_cast<std::uint32_t>(mesh.positions.size());
    }
}

// A hollow ball of two objects is that of one mesh, whose inner wall is turned as it is read.
TEST(Shape, ShellsOfAGroupAreThoseOfOneMesh) {
    const TemporaryFolder folder;
    const std::array<TriangleMesh, 2> spheres{makeSphere(4), makeSphere(2.5)};
    const TranslucentMaterial wax = onShape(grey(0.1, 2, 1.4));
    SceneMaker one = ballUnderSky(wax, 4);
    one.scene.quality.tolerance = 0.1;
    SceneMaker two = one;
    writeObj(folder / "hollow.obj", spheres);
    one.scene.objects[0].shape = MeshFileShape{folder / "hollow.obj"};
    two.scene.objects.clear();
    for (std::size_t k = 0; k < 2; ++k) {
        const char* name = k == 0 ? "outer.obj" : "inner.obj";
        writeObj(folder / name, std::span(spheres).subspan(k, 1));
        two.object(MeshFileShape{folder / name}, 0).group = "hollow";
    }
    const Leaving whole(one.scene), group(two.scene);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(group.leaves[c] / whole.leaves[c], 1, 5e-3);
        EXPECT_NEAR(group.straight[c], whole.straight[c], 1e-3);
    }
    EXPECT_LT(whole.leaves.y, 0.9);
}

class Warnings final : public Reporter {
public:
    void info(std::string_view, std::string_view) override {}
    void warn(std::string_view, std::string_view sentence) override {
        sentences.emplace_back(sentence);
    }
    void progress(std::string_view, double, double, bool) override {}
    std::vector<std::string> sentences;
};

// A box of white and strongly scattering stuff, points as far apart as half of it: unsolvable.
TEST(Shape, PointsTooFarApartKeepTheProfile) {
    for (const double scattering : {10.0, 1000.0, 1e8}) {
        SceneMaker maker;
        TranslucentMaterial material = onShape(grey(0.001, scattering, 1.4));
        material.medium.sigmaS.x = 0.5;  // this one can be
        maker.object(BoxShape{{4, 4, 4}}, maker.material(material));
        maker.light(EnvironmentLight{Rgb(1), {}, 0});
        maker.scene.quality.spacingMm = 2;
        const World world = maker.world();
        const auto optics = makeBodyOptics(world);
        Warnings reporter;
        const MadeClouds made(world, optics, reporter);
        const ShapeExitance& shape = *made.reports[0].shape;
        EXPECT_EQ(shape.isTooCoarse, (std::array{false, true, true})) << scattering;
        for (const SolvedExitance& point : made.clouds[0].solved) {
            EXPECT_EQ(point.correction.y, 0);
            EXPECT_EQ(point.correction.z, 0);
        }
        EXPECT_GT(shape.absorbed.x, -0.02);
        ASSERT_EQ(reporter.sentences.size(), 1u);
        EXPECT_NE(reporter.sentences[0].find("mean free path"), std::string::npos)
            << reporter.sentences[0];
    }
}

// Without an inside there is no shape to solve on: the profile serves.
TEST(Shape, OpenBodiesKeepTheProfile) {
    SceneMaker maker;
    maker.object(RectangleShape{8, 8}, maker.material(onShape(testing::measured("Marble"))));
    maker.light(DirectionalLight{{0, 0, -1}, Rgb(2)});
    struct Listener final : Reporter {
        void info(std::string_view, std::string_view) override {}
        void warn(std::string_view, std::string_view sentence) override { all += sentence; }
        void progress(std::string_view, double, double, bool) override {}
        std::string all;
    } listener;
    const World world(maker.scene, listener);
    EXPECT_NE(listener.all.find("o0: diffusion cannot be solved on a shape without an inside: the "
                                "profile \"dipole\" stands in; close the open edges: o0 (4 edges, "
                                "32 mm around (0, 0, 0) mm)"),
              std::string::npos)
        << listener.all;
    const auto optics = makeBodyOptics(world);
    EXPECT_FALSE(optics[0]->onShape);
    const MadeClouds made(world, optics);
    EXPECT_TRUE(made.clouds[0].solved.empty());
}

}  // namespace
}  // namespace sss
