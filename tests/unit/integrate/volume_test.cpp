#include "sss/medium/half_space.h"
#include "sss/medium/single_scatter.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "unit/integrate/volume_experiment.h"

namespace sss {
namespace {

using namespace testing;

// Without absorption, under a sky of radiance 1, all that a camera sees is 1, path by path.
TEST(Volume, WhiteFurnace) {
    for (const double eta : {0.8, 1.0, 1.33, 1.5, 3.0})
        for (const double g : {-0.9, 0.0, 0.99}) {
            SCOPED_TRACE(::testing::Message() << "eta " << eta << ", g " << g);
            TranslucentMaterial white = grey(0, 4, eta);
            white.medium.g = DRgb(g);
            SceneMaker maker;
            // Bent normals, and boundaries that keep light in.
            if (eta == 1.33)
                maker.object(SphereShape{1}, maker.material(white));
            else
                maker.object(BoxShape{DVec3(2)}, maker.material(white));
            maker.light(sky());
            expectWhiteFurnace(maker);
        }
}

// The same between two blocks of one body, where light leaves and enters again many times: that is
// not for `bounces` to limit, which counts opaque surfaces.
TEST(Volume, WhiteFurnaceOfAConcaveBody) {
    SceneMaker maker;
    maker.scene.quality.bounces = 0;
    const int white = maker.material(grey(0, 10, 1.5));
    for (const double side : {-1.0, 1.0})
        maker.object(BoxShape{{3, 1, 3}}, white, moved({0, 0.6 * side, 0})).group = "pair";
    maker.light(sky());
    const Experiment experiment(maker);
    ASSERT_EQ(experiment.world().bodies().size(), 1u);
    const Estimate e = estimate(16, [&](Sampler& sampler) {
        Ray ray;  // from the middle of the gap
        ray.origin = Vec3(0);
        ray.direction = glm::normalize(Vec3(sampler.next1D() - 0.5f, 1, 0.1f));
        return all(experiment.trace(ray, sampler));
    });
    expectWithin(e, DRgb(1), 1e-4, 1e-4);
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

// Chandrasekhar's H function at mu, by iteration of its integral equation.
double chandrasekharH(double albedo, double mu) {
    constexpr int kNodes = 200;
    const double root = std::sqrt(1 - albedo);
    std::vector<double> h(kNodes, 1.0);
    const auto node = [](int k) { return (k + 0.5) / kNodes; };
    const auto at = [&](double m) {
        double sum = 0;
        for (int k = 0; k < kNodes; ++k)
            sum += node(k) * h[static_cast<std::size_t>(k)] / (m + node(k)) / kNodes;
        return 1 / (root + 0.5 * albedo * sum);
    };
    for (int iteration = 0; iteration < 60; ++iteration) {
        std::vector<double> next;
        for (int k = 0; k < kNodes; ++k) next.push_back(at(node(k)));
        h = std::move(next);
    }
    return at(mu);
}

// By it: isotropic, matched, R(mu) = 1 - sqrt(1 - albedo) H(mu).
TEST(Volume, MatchedHalfSpace) {
    struct Row {
        double albedo, normal, diffuse;
    };
    for (const Row& row :
         {Row{0.9, 0.41494747913082, 0.478024489228}, Row{0.99, 0.7527207171603, 0.794563652902},
          Row{0.9999, 0.97141777553791, 0.977186969447}}) {
        SCOPED_TRACE(row.albedo);
        SceneMaker maker = halfSpace(grey(10 * (1 - row.albedo), 10 * row.albedo, 1));
        maker.light(sky());
        const Experiment experiment(maker);
        const std::uint32_t perBatch = row.albedo > 0.999 ? 128 : 256;  // paths grow long
        const auto along = [&](const Vec3& towards) {
            return estimate(perBatch, [&](Sampler& sampler) {
                return scattered(experiment.trace(downTo(kHalfSize, towards), sampler));
            });
        };
        expectWithin(along({0, 1, 0}), DRgb(row.normal), 0.004);
        const Estimate diffuse = estimate(perBatch, [&](Sampler& sampler) {
            return scattered(experiment.trace(cosineDownTo(kHalfSize, sampler), sampler));
        });
        expectWithin(diffuse, DRgb(row.diffuse), 0.004);
        if (row.albedo > 0.999) continue;  // where the iteration is slow
        const double root = std::sqrt(1 - row.albedo);
        EXPECT_NEAR(1 - root * chandrasekharH(row.albedo, 1), row.normal, 1e-4);
        const double oblique = 1 - root * chandrasekharH(row.albedo, 0.2);
        expectWithin(along({std::sqrt(0.96f), 0.2f, 0}), DRgb(oblique), 0.004, 1e-4);
    }
}

// A channel of a measured medium as a grey one, its coefficients times `scale`.
TranslucentMaterial greyOf(const char* name, int channel, double scale = 1) {
    TranslucentMaterial material = measured(name);
    const ChannelMedium medium = material.medium.channel(channel);
    material.medium.sigmaA = DRgb(medium.sigmaA * scale);
    material.medium.sigmaS = DRgb(medium.sigmaS * scale);
    material.medium.g = DRgb(medium.g);
    return material;
}

// Of the transmitted flux; by analog Monte Carlo elsewhere.
TEST(Volume, MeasuredHalfSpaces) {
    struct Row {
        const char* medium;
        int channel;
        double normal, diffuse, error;
    };
    for (const Row& row :
         {Row{"Marble", 1, 0.79935, 0.80459, 3e-4}, Row{"Skimmilk", 1, 0.82201, 0.83184, 3e-4},
          Row{"Skin1", 2, 0.1155, 0.1246, 3e-4}, Row{"Ketchup", 1, 0.00539, 0.00592, 3e-5}}) {
        SCOPED_TRACE(row.medium);
        // Hundreds of free paths wide, whatever the medium.
        const double scale = 10 / measured(row.medium).medium.channel(row.channel).sigmaT();
        const TranslucentMaterial material = greyOf(row.medium, row.channel, scale);
        const double eta = material.medium.eta;
        SceneMaker maker = halfSpace(material);
        maker.light(sky());
        const Experiment experiment(maker);
        const auto within = [&](Estimate e, double entering, double expected) {
            e.error = glm::sqrt(e.error * e.error + DRgb(row.error * row.error));
            expectWithin(e, DRgb(entering * expected), 0.006);
        };
        const Estimate normal = estimate(256, [&](Sampler& sampler) {
            return scattered(experiment.trace(downTo(kHalfSize), sampler));
        });
        within(normal, 1 - fresnelReflectance(1.0, eta), row.normal);
        const Estimate diffuse = estimate(256, [&](Sampler& sampler) {
            return scattered(experiment.trace(cosineDownTo(kHalfSize, sampler), sampler));
        });
        within(diffuse, hemisphericalTransmittance(eta), row.diffuse);
    }
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
// reflects, and what of it was never scattered; by analog Monte Carlo elsewhere.
TEST(Volume, Spheres) {
    struct Row {
        const char* medium;
        double radius, expected, error, unscattered;
    };
    for (const Row& row :
         {Row{"Marble", 1, 0.89593, 2e-4, -1}, Row{"Marble", 10, 0.81337, 3e-4, -1},
          Row{"Skimmilk", 1, 0.93324, 2e-4, 0.117}, Row{"Skimmilk", 10, 0.88760, 2e-4, -1}}) {
        SCOPED_TRACE(::testing::Message() << row.medium << ' ' << row.radius);
        const TranslucentMaterial material = greyOf(row.medium, 1);
        SceneMaker maker;
        maker.object(SphereShape{row.radius}, maker.material(material));
        maker.light(sky());
        const Experiment experiment(maker);
        const double reflected = 1 - hemisphericalTransmittance(material.medium.eta);
        // All channels are one: here they are all of it, what was not scattered, and nothing.
        Estimate e = estimate(row.radius > 1 ? 64 : 256, [&](Sampler& sampler) {
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
            return DRgb(all(sample).y, DRgb(sample.surface).y, reflected) - reflected;
        });
        EXPECT_NEAR(e.mean.x, row.expected, 3 * std::hypot(e.error.x, row.error));
        EXPECT_LT(e.error.x, 0.01);
        if (row.unscattered < 0) continue;
        EXPECT_NEAR(e.mean.y, row.unscattered, 3 * e.error.y + 5e-4);
        EXPECT_LT(e.error.y, 0.005);
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

}  // namespace
}  // namespace sss
