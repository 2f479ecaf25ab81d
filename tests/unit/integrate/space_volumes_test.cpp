#include "sss/base/error.h"
#include "sss/integrate/irradiance_estimator.h"
#include "sss/optics/phase.h"
#include "unit/integrate/volume_experiment.h"
#include "unit/volume/volume_tools.h"

namespace sss {
namespace {

using namespace testing;

VolumeSettings& addVolume(SceneMaker& maker, VolumeSettings volume, Shape shape,
                          const DVec3& centre = DVec3(0)) {
    volume.name = "v" + std::to_string(maker.scene.volumes.size());
    volume.shape = std::move(shape);
    volume.transform = {moved(centre)};
    maker.scene.volumes.push_back(std::move(volume));
    return maker.scene.volumes.back();
}

void floorAt(SceneMaker& maker, double height, float reflectance) {
    maker.object(RectangleShape{1e4, 1e4}, maker.material(LambertianMaterial{Rgb(reflectance)}),
                 moved({0, height, 0}) * turned(-90, {1, 0, 0}));
}

/// A scene and any integrator, without a first pass.
class View {
public:
    View(const SceneMaker& maker, std::string_view integrator)
        : world_(maker.world()),
          optics_(makeBodyOptics(world_)),
          integrator_(findIntegrator(integrator)->make({world_, optics_, {}})) {}

    /// `ray` as in the scene.
    Estimate along(Ray ray, std::uint32_t perBatch) const {
        ray.origin -= Vec3(world_.originMm());
        return estimate(perBatch, [&](Sampler& sampler) {
            return all(integrator_->trace(ray, sampler, counts_));
        });
    }
    const PathCounts& counts() const { return counts_; }

private:
    World world_;
    std::vector<std::unique_ptr<BodyOptics>> optics_;
    std::unique_ptr<Integrator> integrator_;
    mutable PathCounts counts_;
};

Ray rayFrom(const Vec3& origin, const Vec3& to) {
    Ray ray;
    ray.origin = origin;
    ray.direction = glm::normalize(to - origin);
    return ray;
}

void expectEqual(const Estimate& a, const Estimate& b, double largestError) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(a.mean[c], b.mean[c], 3 * std::hypot(a.error[c], b.error[c]) + 1e-6) << c;
        EXPECT_LT(a.error[c], largestError * a.mean[c]) << c;
        EXPECT_LT(b.error[c], largestError * b.mean[c]) << c;
    }
}

// Without bodies those that differ in bodies only are one, and none needs a first pass.
constexpr std::string_view kAll[] = {"brdf", "bssrdf", "cached", "volume"};

// Scenes without volumes pay nothing: nothing is looked at for them.
TEST(SpaceVolumes, CostNothingWhereThereAreNone) {
    SceneMaker maker;
    floorAt(maker, 0, 0.5f);
    maker.light(sky());
    for (const std::string_view name : kAll) {
        const View view(maker, name);
        view.along(downTo(0), 1);
        EXPECT_EQ(view.counts().volumeStretches, 0u);
        EXPECT_GT(view.counts().rays, 0u);
    }
}

// A slab of absorbing fog lit by the sun, seen at right angles: what is scattered once is known in
// closed form; the fog is so dark that more does not count.
TEST(SpaceVolumes, SlabScattersTheSunOnce) {
    constexpr double kThickness = 2, kIrradiance = 3;
    for (const double mu : {-0.8, 0.6}) {  // of the sun's way down; towards or away from the camera
        SceneMaker maker;
        maker.object(SphereShape{1}, maker.material(LambertianMaterial{}), moved({300, 300, 0}));
        const double sine = std::sqrt(1 - mu * mu);
        maker.light(DirectionalLight{{sine, -mu, 0}, Rgb(kIrradiance)});
        VolumeSettings fog;
        fog.sigmaA = {0.5f, 1, 2};
        fog.sigmaS = fog.sigmaA * 2e-4f;
        fog.g = 0.5;
        addVolume(maker, fog, BoxShape{{1000, kThickness, 1000}});
        DRgb expected;
        for (int c = 0; c < 3; ++c) {
            const double s = double(fog.sigmaS[c]), t = s + double(fog.sigmaA[c]);
            // Depth from the camera's side z: in from that side along z / mu, or from the far one.
            const double slope = 1 + 1 / mu;
            const double far = mu > 0 ? 1.0 : std::exp(t * kThickness / mu);
            const double column = -std::expm1(-t * kThickness * slope) / (t * slope);
            expected[c] = s * henyeyGreenstein(-mu, fog.g) * kIrradiance * column * far;
        }
        for (const std::string_view name : kAll) {
            SCOPED_TRACE(name);
            const Estimate e = View(maker, name).along(downTo(1), name == "volume" ? 4096 : 64);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(e.mean[c], expected[c], 3 * e.error[c] + 2e-3 * expected[c]) << c;
                EXPECT_LT(e.error[c], (name == "volume" ? 0.05 : 0.01) * expected[c]) << c;
            }
        }
    }
}

// Fog that absorbs nothing under an even sky cannot be seen, however thick.
TEST(SpaceVolumes, WhiteFurnace) {
    SceneMaker maker;
    maker.scene.quality.bounces = 64;
    floorAt(maker, -3, 1);
    maker.light(sky());
    VolumeSettings fog;
    fog.sigmaS = {0.2f, 1, 2};
    fog.g = -0.4;
    addVolume(maker, fog, SphereShape{2});
    VolumeSettings more;
    more.sigmaS = {1, 0.5f, 0};
    more.g = 0.7;
    addVolume(maker, more, BoxShape{DVec3(2)}, {1, 0, 0});
    const Estimate e = View(maker, "volume").along(downTo(0), 256);
    expectWithin(e, DRgb(1), 0.02);
}

// Where one scattering is all that counts, the path tracer and radiative transfer agree: a lamp, a
// grid of fog that varies, a floor that lights it from below.
TEST(SpaceVolumes, ThinFogAsByRadiativeTransfer) {
    const TemporaryFolder folder;
    RectangleLight lamp;
    lamp.centre = {3, 6, 1};
    lamp.lookAt = {0, 0, 0};
    lamp.up = {0, 0, 1};
    lamp.widthMm = 3;
    lamp.heightMm = 2;
    lamp.radiance = Rgb(20);
    SceneMaker maker;
    maker.scene.quality.bounces = 1;
    floorAt(maker, -3, 0.5f);
    maker.light(lamp).light(PointLight{{-2, 1, 3}, Rgb(3e-5f)});
    VolumeSettings fog;
    fog.sigmaS = {1e-3f, 2e-3f, 5e-4f};
    fog.sigmaA = {0.5f, 1e-3f, 0.1f};
    fog.g = 0.6;
    fog.grid = writeGrid(folder.path() / "fog.raw", {3, 4, 5}, 1, [](const DVec3& p, int) {
        return static_cast<float>(p.x > 0.2 ? p.y + p.x * p.z : 0);
    });
    addVolume(maker, fog, BoxShape{{4, 2, 5}});
    const Ray ray = rayFrom({0, 0.5f, 12}, {0, 0.1f, 0});  // past the floor
    expectEqual(View(maker, "brdf").along(ray, 256), View(maker, "volume").along(ray, 8192), 0.03);
}

// Light of all kinds is dimmed on its way to a surface.
TEST(SpaceVolumes, ShadowRaysAreDimmed) {
    VolumeSettings smoke;
    smoke.sigmaA = {0.1f, 0.5f, 2};
    for (const std::string_view name : kAll) {
        SceneMaker maker;
        floorAt(maker, 0, 0.5f);
        maker.light(DirectionalLight{{0, -1, 0}, Rgb(2)});
        addVolume(maker, smoke, BoxShape{{20, 1, 20}}, {0, 8, 0});
        const Estimate e = View(maker, name).along(rayFrom({0, 2, 3}, {0, 0, 0}), 16);
        expectWithin(e, DRgb(1 / kPi) * glm::exp(-DRgb(smoke.sigmaA)), 1e-3);
    }
}

// The flux of a thin glowing ball falls off as from its centre: exactly, on every side of it.
constexpr double kBall = 2, kHeight = 5, kGlow = 1e-4 * 700;
double irradianceBelow(double aside) {
    const double square = kHeight * kHeight + aside * aside;
    return kGlow * 4 / 3 * kPi * kBall * kBall * kBall * kHeight / std::pow(square, 1.5);
}

TEST(SpaceVolumes, FlamesLightSurfaces) {
    for (const std::string_view name : kAll) {
        for (const int bounces : {0, 2}) {
            SceneMaker maker;
            maker.scene.quality.bounces = bounces;
            floorAt(maker, -kHeight, 0.5f);
            addVolume(maker, greyVolume(1e-4f, 0, 700), SphereShape{kBall});
            const Estimate e = View(maker, name).along(rayFrom({8, 0, 0}, {3, -kHeight, 0}), 256);
            const double expected = 0.5 / kPi * irradianceBelow(3);
            expectWithin(e, DRgb(expected), 0.01 * expected, 1e-3 * expected);
        }
    }
}

// Pass 1 sees it, too.
TEST(SpaceVolumes, FlamesLightBodies) {
    SceneMaker maker;
    maker.object(BoxShape{{40, 2, 40}}, maker.material(grey(0.1, 1, 1)),
                 moved({0, -kHeight - 1, 0}));
    addVolume(maker, greyVolume(1e-4f, 0, 700), SphereShape{kBall});
    const World world = maker.world();
    const auto optics = makeBodyOptics(world);
    const PathTracer tracer(world, optics, {});
    const IrradianceEstimator estimator(world, tracer, 1.0f);
    Hit found;
    ASSERT_TRUE(world.rays().intersect(
        rayFrom(Vec3(DVec3(3, 0, 0) - world.originMm()), Vec3(DVec3(3, -9, 0) - world.originMm())),
        found));
    const SurfaceHit hit = world.surfaceAt(found);
    PathCounts counts;
    const Estimate e = estimate(
        256, [&](Sampler& sampler) { return DRgb(estimator.estimate(hit, sampler, counts)); });
    expectWithin(e, DRgb(irradianceBelow(3)), 0.01 * irradianceBelow(3), 1e-3 * irradianceBelow(3));
}

// A flame that dims itself, from a grid, with a plate within it that hides half, in smoke: by
// light sampling and by chance.
TEST(SpaceVolumes, FlamesAroundThingsAsByRadiativeTransfer) {
    const TemporaryFolder folder;
    SceneMaker maker;
    maker.scene.quality.bounces = 0;
    floorAt(maker, -3, 0.5f);
    maker.object(RectangleShape{2, 1}, maker.material(LambertianMaterial{Rgb(0)}),
                 turned(-90, {1, 0, 0}));
    VolumeSettings flame;
    flame.sigmaA = {0.4f, 1, 2};
    flame.emission = {20, 10, 5};
    flame.grid = writeGrid(folder.path() / "flame.raw", {6, 7, 5}, 4, [](const DVec3& p, int c) {
        return static_cast<float>(p.x * (1 - p.x) * (c == 2 ? 3 * p.y : p.z));
    });
    addVolume(maker, flame, CylinderShape{1.5, 4});
    addVolume(maker, greyVolume(0.1f, 0), BoxShape{{6, 6, 6}}, {1, 0, 0});
    const Ray floor = rayFrom({6, 1, 0.5f}, {1, -3, 0.2f});
    expectEqual(View(maker, "brdf").along(floor, 256), View(maker, "volume").along(floor, 256),
                0.02);
    const Ray through = rayFrom({6, 0.5f, 1}, {0, -0.3f, 0});
    expectEqual(View(maker, "brdf").along(through, 16), View(maker, "volume").along(through, 16),
                0.05);
}

// A body in fog: what lies behind is dimmed by what lies before it.
TEST(SpaceVolumes, BodiesAreSeenThroughSmoke) {
    const auto seen = [](std::string_view name, bool inSmoke) {
        SceneMaker maker;
        maker.object(BoxShape{{20, 2, 20}}, maker.material(grey(0.01, 5, 1.3)), moved({0, -6, 0}));
        maker.light(PointLight{{0, 0, 1}, Rgb(1e-3f)});
        VolumeSettings smoke;
        smoke.sigmaA = {0.1f, 0.2f, 0.3f};
        if (inSmoke) addVolume(maker, smoke, BoxShape{{9, 2, 9}}, {0, 4, 0});
        return View(maker, name).along(downTo(6), 16).mean;
    };
    for (const std::string_view name : {"brdf", "bssrdf", "lambertian"}) {
        SCOPED_TRACE(name);
        const DRgb clear = seen(name, false), dimmed = seen(name, true);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(dimmed[c], clear[c] * std::exp(-0.2 * (c + 1)), 1e-5 * clear[c]);
    }
}

TEST(SpaceVolumes, NeedAnInside) {
    const TemporaryFolder folder;
    std::ofstream(folder / "flag.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    SceneMaker maker;
    floorAt(maker, 0, 0.5f);
    addVolume(maker, greyVolume(1, 0), MeshFileShape{folder / "flag.obj"}).line = 5;
    try {
        maker.world();
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(
            std::string(error.what()),
            "test.json:5:0: the surface of the volume \"v0\" is not closed, so that it has no "
            "inside; close the mesh, or take a box or a sphere around it");
    }
}

}  // namespace
}  // namespace sss
