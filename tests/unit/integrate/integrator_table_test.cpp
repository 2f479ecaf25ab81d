#include "sss/integrate/integrator_table.h"

#include "sss/base/error.h"
#include "sss/base/json.h"
#include "sss/base/warp.h"
#include "sss/integrate/preprocess.h"
#include "sss/integrate/renderer.h"
#include "sss/medium/half_space.h"
#include "sss/medium/single_scatter.h"
#include "sss/optics/fresnel_moments.h"
#include "unit/integrate/batches.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

namespace sss {
namespace {

using testing::grey;
using testing::SceneMaker;

TEST(IntegratorTable, Names) {
    EXPECT_EQ(QualitySettings{}.integrator, "cached");
    for (const IntegratorKind& kind : integratorTable())
        EXPECT_EQ(findIntegrator(kind.name), &kind);
    EXPECT_EQ(findIntegrator("none"), nullptr);
    SceneMaker maker;
    maker.scene.quality.integrator = "volumes";
    try {
        integratorOf(maker.scene);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::BadInput);
        EXPECT_NE(std::string(e.what()).find("did you mean \"volume\""), std::string::npos);
    }
}

TEST(IntegratorTable, IsTheSchemas) {
    const JsonValue schema =
        readJsonFile(std::filesystem::path(SSS_SOURCE_DIR) / "scenes/scene.schema.json");
    const JsonValue* at = &schema;
    for (const char* key : {"$defs", "quality", "properties", "integrator", "enum"}) {
        const JsonMember* member = at->find(key);
        ASSERT_NE(member, nullptr) << key;
        at = &member->value;
    }
    std::set<std::string> inSchema, inTable;
    for (const JsonValue& name : at->items()) inSchema.insert(name.asString());
    for (const IntegratorKind& kind : integratorTable()) inTable.emplace(kind.name);
    EXPECT_EQ(inTable, inSchema);
}

// Without absorption and under a sky of radiance 1 the diffuse limit and the gloss upon it make 1,
// the one with F_t and the other with F_r of the way to the camera.
TEST(DiffuseLimit, WhiteFurnace) {
    for (const double roughness : {0.0, 0.4}) {
        SceneMaker maker;
        TranslucentMaterial white = grey(0, 5, 1.5);
        white.roughness = roughness;
        white.singleScattering = false;
        maker.object(BoxShape{DVec3(4)}, maker.material(white));
        maker.light(EnvironmentLight{Rgb(1), {}, 0});
        const World world = maker.world();
        const auto optics = makeBodyOptics(world);
        const auto integrator = findIntegrator("brdf")->make({world, optics, {}});
        Ray ray;
        ray.origin = {0.1f, 0.2f, 7};
        ray.direction = {0, 0, -1};
        PathCounts counts;
        DRgb surface(0);
        const testing::Estimate e = testing::batchEstimate(1, 64, [&](Sampler& sampler) {
            const FilmSample sample = integrator->trace(ray, sampler, counts);
            surface += DRgb(sample.surface) / (32.0 * 64.0);
            return DRgb(sample.diffusion);
        });
        EXPECT_NEAR(e.mean.y, 0.96, 3 * e.error.y + 1e-4);
        EXPECT_NEAR(surface.y, 0.04, 0.002);
    }
}

// With the closed form of single scattering the share of each part is the energy convention's, in
// the mean over the directions towards the camera.
TEST(DiffuseLimit, SingleScatteringOfTheHalfSpace) {
    TranslucentMaterial material = grey(0.5, 4, 1.4);
    material.medium.sigmaA = {0, 0.5, 4};
    material.medium.g = {0.5, 0, 0.8};
    SceneMaker maker;
    maker.object(BoxShape{DVec3(4)}, maker.material(material));
    maker.light(EnvironmentLight{Rgb(1), {}, 0});
    const World world = maker.world();
    const auto optics = makeBodyOptics(world);
    const auto integrator = findIntegrator("brdf")->make({world, optics, {}});
    PathCounts counts;
    DRgb both(0);
    const testing::Estimate single = testing::batchEstimate(1, 256, [&](Sampler& sampler) {
        const Vec3 towards = cosineDirection(sampler.next2D());
        Ray ray;
        ray.origin = Vec3(0.1f, 0.2f, 2) + 3.0f * towards;
        ray.direction = -towards;
        const FilmSample sample = integrator->trace(ray, sampler, counts);
        both += DRgb(sample.single + sample.diffusion) / (32.0 * 256.0);
        return DRgb(sample.single);
    });
    const double entering = hemisphericalTransmittance(1.4);
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium medium = material.medium.channel(c);
        EXPECT_NEAR(single.mean[c], entering * singleScatterAlbedo(medium, Illumination::Diffuse),
                    4 * single.error[c]);
        EXPECT_LT(single.error[c], 0.01 * single.mean[c]);
        EXPECT_NEAR(both[c], entering * halfSpaceTotals(medium).diffuse, 0.005);
    }
}

// No Fresnel, no gloss: what is seen is the reflectance, from wherever.
TEST(Lambertian, ReflectsTheTotal) {
    TranslucentMaterial material = grey(0.5, 4, 1.4);
    SceneMaker maker;
    maker.object(BoxShape{DVec3(4)}, maker.material(material));
    maker.light(DirectionalLight{{0, 0, -1}, Rgb(kPiF)});
    const World world = maker.world();
    const auto optics = makeBodyOptics(world);
    const auto integrator = findIntegrator("lambertian")->make({world, optics, {}});
    for (const Vec3& towards : {Vec3(0, 0, 1), Vec3(0.8f, 0, 0.6f)}) {
        Ray ray;
        ray.origin = Vec3(0.1f, 0.2f, 2) + 3.0f * towards;
        ray.direction = -towards;
        PathCounts counts;
        Sampler sampler(1, 0);
        const FilmSample sample = integrator->trace(ray, sampler, counts);
        EXPECT_NEAR(sample.diffusion.y, optics[0]->profiles[1]->total(), 1e-6);
        EXPECT_EQ(sample.surface + sample.single, Rgb(0));
    }
}

// The same bytes twice, by every integrator that needs no cache.
TEST(IntegratorTable, RendersWithoutFields) {
    for (const char* name : {"brdf", "bssrdf", "lambertian", "volume"}) {
        SceneMaker maker;
        maker.scene.quality.integrator = name;
        maker.scene.camera.position = {0, 0, 9};
        maker.scene.camera.lookAt = {0, 0, 0};
        maker.object(BoxShape{DVec3(4)}, maker.material(grey(0.1, 5, 1.5)));
        maker.light(EnvironmentLight{Rgb(1), {}, 0});
        const World world = maker.world();
        const auto optics = makeBodyOptics(world);
        SilentReporter silent;
        const RenderResult result = render(world, optics, {}, silent);
        EXPECT_EQ(result.dropped.samples, 0u);
        const ImageLayer* diffusion = result.image.find("diffusion");
        ASSERT_NE(diffusion, nullptr);
        const std::size_t middle = 3 * (8 * 16 + 8);
        EXPECT_GT(diffusion->values[middle], 0.1f) << name;
        EXPECT_LT(diffusion->values[middle], 1.0f) << name;
        EXPECT_EQ(render(world, optics, {}, silent).image.find("diffusion")->values,
                  diffusion->values);
    }
}

}  // namespace
}  // namespace sss
