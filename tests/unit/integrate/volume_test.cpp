#include "sss/base/error.h"
#include "sss/base/warp.h"
#include "sss/integrate/integrator_table.h"
#include "sss/integrate/preprocess.h"
#include "sss/integrate/single_scatter.h"
#include "sss/medium/half_space.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

#include <functional>

namespace sss {
namespace {

using testing::grey;
using testing::measured;
using testing::moved;
using testing::SceneMaker;
using testing::turned;

struct Estimate {
    DRgb mean{0}, error{0};
};

// Means over batches that are stratified in themselves and independent of each other.
Estimate estimate(std::uint32_t perBatch, const std::function<DRgb(Sampler&)>& sample) {
    constexpr std::uint32_t kBatches = 32;
    DRgb sum(0), squares(0);
    for (std::uint32_t b = 0; b < kBatches; ++b) {
        DRgb batch(0);
        for (std::uint32_t i = 0; i < perBatch; ++i) {
            Sampler sampler(combineSeeds(4711, b), i);
            batch += sample(sampler);
        }
        batch /= perBatch;
        sum += batch;
        squares += batch * batch;
    }
    Estimate e;
    e.mean = sum / static_cast<double>(kBatches);
    const DRgb variance = squares / static_cast<double>(kBatches) - e.mean * e.mean;
    e.error = glm::sqrt(glm::max(variance, DRgb(0)) / static_cast<double>(kBatches - 1));
    return e;
}

// Within 3 standard errors, which must be small enough to say something; `slack` is the error of
// the expectation itself.
void expectWithin(const Estimate& e, const DRgb& expected, double largestError,
                  double slack = 1e-5) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(e.mean[c], expected[c], 3 * e.error[c] + slack) << "channel " << c;
        EXPECT_LT(e.error[c], largestError) << "channel " << c;
    }
}

// A scene and the integrator "volume" upon it.
class Experiment {
public:
    explicit Experiment(const SceneMaker& maker)
        : world_(maker.world()),
          optics_(makeBodyOptics(world_)),
          integrator_(findIntegrator("volume")->make({world_, optics_, {}})) {}

    FilmSample trace(const Ray& ray, Sampler& sampler) const {
        return integrator_->trace(ray, sampler, counts_);
    }
    const World& world() const { return world_; }
    const BodyOptics& optics() const { return *optics_[0]; }
    const PathCounts& counts() const { return counts_; }

private:
    World world_;
    std::vector<std::unique_ptr<BodyOptics>> optics_;
    std::unique_ptr<Integrator> integrator_;
    mutable PathCounts counts_;
};

DRgb scattered(const FilmSample& s) { return DRgb(s.diffusion) + DRgb(s.single); }
DRgb all(const FilmSample& s) { return scattered(s) + DRgb(s.surface); }

Ray downTo(float height, const Vec3& towardsCamera = {0, 1, 0}) {
    Ray ray;
    ray.origin = Vec3(0.31f, height, -0.23f) + towardsCamera * 2.0f;
    ray.direction = -towardsCamera;
    return ray;
}
// So that what is seen is flux per pi.
Ray cosineDownTo(float height, Sampler& sampler) {
    const Vec3 local = cosineDirection(sampler.next2D());
    return downTo(height, glm::normalize(Vec3(local.x, std::max(local.z, 1e-4f), local.y)));
}

constexpr float kHalfSize = 25;  // mm; hundreds of free paths
SceneMaker halfSpace(const TranslucentMaterial& material) {
    SceneMaker maker;
    maker.object(BoxShape{DVec3(2 * kHalfSize)}, maker.material(material));
    return maker;
}
SceneMaker slab(const TranslucentMaterial& material, double thickness) {
    SceneMaker maker;
    maker.object(BoxShape{{100, thickness, 100}}, maker.material(material));
    return maker;
}
LightSettings sky(float radiance = 1) { return EnvironmentLight{Rgb(radiance), {}, 0}; }
// Nothing comes from below.
void blackFloor(SceneMaker& maker, double height) {
    maker.object(RectangleShape{1e5, 1e5}, maker.material(LambertianMaterial{Rgb(0)}),
                 moved({0, height, 0}) * turned(-90, {1, 0, 0}));
}
void blackCeiling(SceneMaker& maker, double height) {
    maker.object(RectangleShape{1e5, 1e5}, maker.material(LambertianMaterial{Rgb(0)}),
                 moved({0, height, 0}) * turned(90, {1, 0, 0}));
}

// Without absorption, under a sky of radiance 1, all that a camera sees is 1, path by path.
TEST(Volume, WhiteFurnace) {
    for (const double eta : {0.8, 1.0, 1.33, 2.0})
        for (const double g : {-0.9, 0.0, 0.9}) {
            SCOPED_TRACE(::testing::Message() << "eta " << eta << ", g " << g);
            TranslucentMaterial white = grey(0, 4, eta);
            white.medium.g = DRgb(g);
            SceneMaker maker;
            maker.object(SphereShape{1}, maker.material(white));
            maker.light(sky());
            const Experiment experiment(maker);
            const Estimate e = estimate(16, [&](Sampler& sampler) {
                Ray ray;
                ray.origin = Vec3(Vec2(1.8f) * (sampler.next2D() - 0.5f), 3.0f);
                ray.direction = {0, 0, -1};
                return all(experiment.trace(ray, sampler));
            });
            expectWithin(e, DRgb(1), 1e-4, 1e-4);
            EXPECT_EQ(experiment.counts().lost, 0u);
        }
}

// Each channel by the lead of any other.
TEST(Volume, ColouredWhiteFurnace) {
    TranslucentMaterial white = grey(0, 4, 1.4);
    white.medium.sigmaS = {1, 4, 12};
    white.medium.g = {0.7, -0.3, 0.8};
    SceneMaker maker;
    maker.object(BoxShape{DVec3(1)}, maker.material(white));
    maker.light(sky());
    const Experiment experiment(maker);
    const Estimate e = estimate(512, [&](Sampler& sampler) {
        return all(experiment.trace(downTo(0.5f, glm::normalize(Vec3(0.5f, 1, 0.2f))), sampler));
    });
    expectWithin(e, DRgb(1), 0.01);
}

// [van de Hulst 1980], by way of [Wang, Jacques & Zheng 1995, table 1].
TEST(Volume, MatchedSlab) {
    TranslucentMaterial material = grey(1, 9, 1);
    material.medium.g = DRgb(0.75);
    SceneMaker maker = slab(material, 0.2);
    maker.light(sky());
    SceneMaker reflecting = maker, transmitting = maker;
    blackFloor(reflecting, -1);
    blackCeiling(transmitting, 1);
    const Experiment above(reflecting), below(transmitting);
    const auto normal = [](const Experiment& experiment, float height) {
        return estimate(1024, [&, height](Sampler& sampler) {
            Ray ray = downTo(height);
            ray.origin.y = height + 0.5f;
            return all(experiment.trace(ray, sampler));
        });
    };
    expectWithin(normal(above, 0.1f), DRgb(0.09739), 0.002);
    expectWithin(normal(below, 0.1f), DRgb(0.66096), 0.004);
}

// [Giovanelli 1955]: 0.2600 in all; by adding-doubling 0.25994.
TEST(Volume, MismatchedHalfSpace) {
    SceneMaker maker = halfSpace(grey(1, 9, 1.5));
    maker.light(sky());
    const Experiment experiment(maker);
    const Estimate inside = estimate(1024, [&](Sampler& sampler) {
        return scattered(experiment.trace(downTo(kHalfSize), sampler));
    });
    expectWithin(inside, DRgb(0.22), 0.003, 1e-4);
    const Estimate surface = estimate(256, [&](Sampler& sampler) {
        return DRgb(experiment.trace(downTo(kHalfSize), sampler).surface);
    });
    expectWithin(surface, DRgb(0.04), 0.001);
}

// Chandrasekhar's H function: isotropic, matched.
TEST(Volume, MatchedHalfSpace) {
    struct Row {
        double albedo, normal, diffuse;
    };
    for (const Row& row :
         {Row{0.9, 0.41494747913082, 0.478024489228}, Row{0.99, 0.7527207171603, 0.794563652902}}) {
        SCOPED_TRACE(row.albedo);
        SceneMaker maker = halfSpace(grey(10 * (1 - row.albedo), 10 * row.albedo, 1));
        maker.light(sky());
        const Experiment experiment(maker);
        const Estimate normal = estimate(512, [&](Sampler& sampler) {
            return scattered(experiment.trace(downTo(kHalfSize), sampler));
        });
        expectWithin(normal, DRgb(row.normal), 0.003);
        const Estimate diffuse = estimate(512, [&](Sampler& sampler) {
            return scattered(experiment.trace(cosineDownTo(kHalfSize, sampler), sampler));
        });
        expectWithin(diffuse, DRgb(row.diffuse), 0.003);
    }
}

// The same total the other way round: the sun's light, which only light sampling finds.
TEST(Volume, LightSamplingInsideMatchedBodies) {
    SceneMaker maker = halfSpace(grey(1, 9, 1));
    maker.light(DirectionalLight{{0, -1, 0}, Rgb(1)});
    const Experiment experiment(maker);
    const Estimate e = estimate(512, [&](Sampler& sampler) {
        return kPi * scattered(experiment.trace(cosineDownTo(kHalfSize, sampler), sampler));
    });
    expectWithin(e, DRgb(0.41494747913082), 0.005);
}

// Three media that differ in all they can, each against adding-doubling.
TEST(Volume, ColouredHalfSpace) {
    TranslucentMaterial material = grey(0, 0, 1.3);
    material.medium.sigmaA = {0.2, 0.5, 4};
    material.medium.sigmaS = {20, 12, 8};
    material.medium.g = {0.85, 0.3, -0.5};
    SceneMaker maker = halfSpace(material);
    maker.light(sky());
    const Experiment experiment(maker);
    const double normalIn = 1 - fresnelReflectance(1.0, 1.3);
    const double diffuseIn = hemisphericalTransmittance(1.3);
    DRgb normal, diffuse, single;
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium medium = material.medium.channel(c);
        const HalfSpaceTotals totals = halfSpaceTotals(medium);
        normal[c] = normalIn * totals.normal;
        diffuse[c] = diffuseIn * totals.diffuse;
        single[c] = diffuseIn * singleScatterAlbedo(medium, Illumination::Diffuse);
    }
    const Estimate perpendicular = estimate(512, [&](Sampler& sampler) {
        return scattered(experiment.trace(downTo(kHalfSize), sampler));
    });
    expectWithin(perpendicular, normal, 0.008, 1e-4);
    const auto diffuseLight = [&](const auto& part) {
        return estimate(512, [&](Sampler& sampler) {
            return part(experiment.trace(cosineDownTo(kHalfSize, sampler), sampler));
        });
    };
    expectWithin(diffuseLight(scattered), diffuse, 0.008, 1e-4);
    expectWithin(diffuseLight([](const FilmSample& s) { return DRgb(s.single); }), single, 0.004);
}

// Spheres under an even sky: flux that leaves per flux that arrives, but for what the surface
// reflects; by analog Monte Carlo elsewhere.
TEST(Volume, Spheres) {
    struct Row {
        const char* medium;
        double radius, expected, error;
    };
    for (const Row& row : {Row{"Marble", 1, 0.89593, 2e-4}, Row{"Marble", 10, 0.81337, 3e-4},
                           Row{"Skimmilk", 1, 0.93324, 2e-4}, Row{"Skimmilk", 10, 0.88760, 2e-4}}) {
        SCOPED_TRACE(::testing::Message() << row.medium << ' ' << row.radius);
        TranslucentMaterial material = measured(row.medium);
        const ChannelMedium green = material.medium.channel(1);
        material.medium.sigmaA = DRgb(green.sigmaA);
        material.medium.sigmaS = DRgb(green.sigmaS);
        material.medium.g = DRgb(green.g);
        SceneMaker maker;
        maker.object(SphereShape{row.radius}, maker.material(material));
        maker.light(sky());
        const Experiment experiment(maker);
        const double reflected = 1 - hemisphericalTransmittance(green.eta);
        const Estimate e = estimate(row.radius > 1 ? 64 : 256, [&](Sampler& sampler) {
            // Parallel rays over the disk meet the sphere as light from everywhere does.
            FilmSample sample;
            while (sample.alpha == 0) {
                const Vec2 u = sampler.next2D();
                const float r = static_cast<float>(row.radius) * std::sqrt(u.x);
                Ray ray;
                ray.origin = {r * std::cos(2 * kPiF * u.y), r * std::sin(2 * kPiF * u.y), 50};
                ray.direction = {0, 0, -1};
                sample = experiment.trace(ray, sampler);
            }
            return all(sample) - reflected;
        });
        expectWithin(e, DRgb(row.expected), 0.01, 3 * row.error);
    }
}

// Without scattering: Beer and Lambert, with the reflections between two parallel boundaries.
TEST(Volume, ClearSlab) {
    for (const double eta : {1.0, 1.5}) {
        SCOPED_TRACE(eta);
        TranslucentMaterial clear = grey(0, 0, eta);
        clear.medium.sigmaA = {0.1, 0.7, 3};
        SceneMaker maker = slab(clear, 0.8);
        maker.light(sky());
        blackCeiling(maker, 1);
        const Experiment experiment(maker);
        const double once = fresnelReflectance(1.0, eta);
        DRgb expected;
        for (int c = 0; c < 3; ++c) {
            const double passed = std::exp(-clear.medium.sigmaA[c] * 0.8);
            expected[c] = (1 - once) * (1 - once) * passed / (1 - once * once * passed * passed);
        }
        DRgb other(0);
        const Estimate e = estimate(1024, [&](Sampler& sampler) {
            Ray ray = downTo(0.4f);
            ray.origin.y = 0.9f;
            const FilmSample sample = experiment.trace(ray, sampler);
            other += scattered(sample);
            return DRgb(sample.surface);
        });
        expectWithin(e, expected, 0.005);
        EXPECT_EQ(other, DRgb(0));
    }
}

// A matched sphere scatters once as integrate/single_scatter says, by sun and by lamp.
TEST(Volume, SingleScatteringOfASphere) {
    RectangleLight lamp;
    lamp.centre = {2, 3, 1};
    lamp.lookAt = {0, 0, 0};
    lamp.up = {0, 0, 1};
    lamp.widthMm = 3;
    lamp.heightMm = 2;
    lamp.radiance = Rgb(5);
    for (const LightSettings& light :
         {LightSettings(lamp), LightSettings(DirectionalLight{{0.2, -1, -0.3}, Rgb(2)})}) {
        TranslucentMaterial material = grey(0.1, 1, 1);
        material.medium.sigmaS = {0.5, 1, 2};
        material.medium.g = {0.6, 0.2, -0.4};
        SceneMaker maker;
        maker.object(SphereShape{1}, maker.material(material));
        maker.light(light);
        const Experiment experiment(maker);
        const World& world = experiment.world();
        Ray ray;
        ray.origin = {0.3f, 0.2f, 3};
        ray.direction = {0, 0, -1};
        const Estimate traced = estimate(
            1024, [&](Sampler& sampler) { return DRgb(experiment.trace(ray, sampler).single); });
        Hit found;
        ASSERT_TRUE(world.rays().intersect(ray, found));
        const SurfaceHit hit = world.surfaceAt(found);
        const Estimate direct = estimate(1024, [&](Sampler& sampler) {
            SingleScatterCounts counts;
            return DRgb(singleScattering(
                world, experiment.optics(), hit, -ray.direction, hit.shadingNormal, sampler,
                [&](const Ray& outward, const Vec3& from, float pdf) {
                    return radianceOfLights(world, outward, std::numeric_limits<float>::infinity(),
                                            {from, pdf});
                },
                counts));
        });
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(traced.mean[c], direct.mean[c],
                        3 * std::hypot(traced.error[c], direct.error[c]));
            EXPECT_LT(traced.error[c], 0.02 * traced.mean[c]);
        }
    }
}

// A lamp behind a matched body: what the floor in its shadow receives is dimmed, not blocked.
TEST(Volume, LightThroughMatchedBodies) {
    SceneMaker maker = slab(grey(0.5, 0, 1), 2);
    maker.object(RectangleShape{50, 50}, maker.material(LambertianMaterial{Rgb(0.5f)}),
                 moved({0, -3, 0}) * turned(-90, {1, 0, 0}));
    maker.light(DirectionalLight{{0, -1, 0}, Rgb(2)});
    const Experiment experiment(maker);
    const Estimate e = estimate(
        64, [&](Sampler& sampler) { return DRgb(experiment.trace(downTo(1), sampler).surface); });
    expectWithin(e, DRgb(0.5 * 2 / kPi * std::exp(-2.0)), 0.01);
}

// What the layers say when a material leaves one of them out.
TEST(Volume, LayersAsTheMaterialSaysThem) {
    TranslucentMaterial material = grey(0.5, 5, 1.3);
    const auto seen = [&] {
        SceneMaker maker = halfSpace(material);
        maker.light(sky());
        const Experiment experiment(maker);
        FilmSample sum;
        for (std::uint32_t i = 0; i < 256; ++i) {
            Sampler sampler(3, i);
            const FilmSample s = experiment.trace(downTo(kHalfSize), sampler);
            sum.diffusion += s.diffusion;
            sum.single += s.single;
            sum.surface += s.surface;
        }
        return sum;
    };
    const FilmSample plain = seen();
    EXPECT_GT(plain.single.y, 0);
    EXPECT_GT(plain.surface.y, 0);
    material.singleScattering = false;
    const FilmSample joined = seen();
    EXPECT_EQ(joined.single, Rgb(0));
    EXPECT_NEAR(joined.diffusion.y, plain.diffusion.y + plain.single.y, 1e-3);
    material.multipleScattering = material.surfaceReflection = false;
    const FilmSample nothing = seen();
    EXPECT_EQ(nothing.diffusion, Rgb(0));
    EXPECT_EQ(nothing.surface, Rgb(0));
}

std::string refusal(const SceneMaker& maker) {
    try {
        const Experiment experiment(maker);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::BadInput);
        return e.what();
    }
    return {};
}

TEST(Volume, RefusesWhatItCannotTrace) {
    SceneMaker open;
    open.object(RectangleShape{1, 1}, open.material(grey(1, 1, 1)));
    EXPECT_NE(refusal(open).find("not closed"), std::string::npos);

    TranslucentMaterial material = grey(1, 1, 1.5);
    SceneMaker sunlit = halfSpace(material);
    sunlit.light(DirectionalLight{{0, -1, 0}, Rgb(1)});
    EXPECT_NE(refusal(sunlit).find("directional"), std::string::npos);

    material.roughness = 0.3;
    EXPECT_NE(refusal(halfSpace(material)).find("rough"), std::string::npos);
    material.medium.eta = 1;
    EXPECT_EQ(refusal(halfSpace(material)), "");
}

}  // namespace
}  // namespace sss
