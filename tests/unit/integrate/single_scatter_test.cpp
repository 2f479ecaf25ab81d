#include "sss/integrate/single_scatter.h"

#include "sss/integrate/path_tracer.h"
#include "sss/integrate/preprocess.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/phase.h"
#include "unit/integrate/batches.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::Estimate;
using testing::measured;
using testing::SceneMaker;

constexpr double kHalfSize = 25;  // mm; hundreds of mean free paths of extinction

Vec3 directionInDegrees(double thetaDegrees, double phiDegrees) {
    const double t = glm::radians(thetaDegrees), p = glm::radians(phiDegrees);
    return Vec3(DVec3(std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p)));
}

SceneMaker halfSpace(const TranslucentMaterial& material) {
    SceneMaker maker;
    maker.object(BoxShape{DVec3(2 * kHalfSize)}, maker.material(material));
    return maker;
}

// The closed form of the half-space, per unit of perpendicular irradiance.
double rigorous(const ChannelMedium& m, double muI, double muO, double cosAzimuths) {
    const double muIn = refractedCosine(muI, m.eta), muOut = refractedCosine(muO, m.eta);
    const double sines = std::sqrt((1 - muI * muI) * (1 - muO * muO));
    const double cosTheta = -sines / (m.eta * m.eta) * cosAzimuths - muIn * muOut;
    return m.albedo() * henyeyGreenstein(cosTheta, m.g) * (1 - fresnelReflectance(muI, m.eta)) *
           (1 - fresnelReflectance(muO, m.eta)) * muI / (m.eta * m.eta * (muIn + muOut));
}

// Single scattering at the middle of the top of body 0, by batches that are stratified in
// themselves and independent of each other.
class ScatterExperiment {
public:
    explicit ScatterExperiment(const SceneMaker& maker)
        : world_(maker.world()), optics_(makeBodyOptics(world_)), tracer_(world_, optics_, {}) {}

    Estimate run(const Vec3& wo, std::uint32_t perBatch = 2048) const {
        return run(wo, perBatch, [this](const Ray& ray, const Vec3& from, float pdf) {
            PathCounts counts;
            Sampler sampler(9, 0);
            return tracer_.incoming(ray, {from, pdf}, 0, sampler, counts);
        });
    }
    Estimate run(const Vec3& wo, std::uint32_t perBatch, const IncomingRadiance& incoming) const {
        const SurfaceHit hit = surface(wo);
        return testing::batchEstimate(77, perBatch, [&](Sampler& sampler) {
            SingleScatterCounts counts;
            return DRgb(singleScattering(world_, *optics_[0], hit, wo, Vec3(0, 1, 0), sampler,
                                         incoming, counts));
        });
    }

private:
    SurfaceHit surface(const Vec3& wo) const {
        const Vec3 target(0.3f, static_cast<float>(kHalfSize), -0.2f);
        Ray ray;
        ray.direction = -wo;
        ray.origin = target + wo * 5.0f;
        Hit hit;
        EXPECT_TRUE(world_.rays().intersect(ray, hit, bodyMask(0)));
        return world_.surfaceAt(hit);
    }
    World world_;
    std::vector<std::unique_ptr<BodyOptics>> optics_;
    PathTracer tracer_;
};

void expectScattered(const Estimate& e, const DRgb& expected, double mostRelativeError) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(e.mean[c], expected[c], 3 * e.error[c] + 1e-5 * expected[c]) << "channel " << c;
        EXPECT_LT(e.error[c], mostRelativeError * expected[c]) << "channel " << c;
    }
}

struct Angles {
    double in, out, azimuths;  // degrees
    double marbleGreen;        // the closed form, computed elsewhere
};
constexpr Angles kRows[] = {{0, 0, 0, 0.016272002352135},     {0, 45, 0, 0.017108549365792},
                            {30, 60, 0, 0.015175013702397},   {45, 45, 180, 0.012769785444571},
                            {60, 30, 90, 0.0087612982460352}, {75, 15, 135, 0.0037444650103068}};

SceneMaker sunlit(const char* medium, const Angles& row) {
    SceneMaker maker = halfSpace(measured(medium));
    maker.light(DirectionalLight{-DVec3(directionInDegrees(row.in, 0)), Rgb(1)});
    return maker;
}

DRgb rigorousRow(const Medium& medium, const Angles& row) {
    DRgb expected;
    for (int c = 0; c < 3; ++c)
        expected[c] =
            rigorous(medium.channel(c), std::cos(glm::radians(row.in)),
                     std::cos(glm::radians(row.out)), std::cos(glm::radians(row.azimuths)));
    return expected;
}

TEST(SingleScattering, HalfSpaceOfMarble) {
    for (const Angles& row : kRows) {
        SCOPED_TRACE(row.in);
        const DRgb expected = rigorousRow(measured("Marble").medium, row);
        EXPECT_NEAR(expected.y, row.marbleGreen, 1e-9 * row.marbleGreen);
        const ScatterExperiment experiment(sunlit("Marble", row));
        expectScattered(experiment.run(directionInDegrees(row.out, row.azimuths)), expected, 0.005);
    }
}

TEST(SingleScattering, HalfSpaceOfForwardScatteringMilk) {
    for (const Angles& row : kRows) {
        SCOPED_TRACE(row.in);
        const ScatterExperiment experiment(sunlit("Regular Milk", row));
        expectScattered(experiment.run(directionInDegrees(row.out, row.azimuths)),
                        rigorousRow(measured("Regular Milk").medium, row), 0.005);
    }
}

TEST(SingleScattering, UnmatchedIndexBelowOne) {
    TranslucentMaterial bubble = testing::grey(0.5, 10, 0.75);
    const Angles row{20, 25, 60, 0};
    SceneMaker maker = halfSpace(bubble);
    maker.light(DirectionalLight{-DVec3(directionInDegrees(row.in, 0)), Rgb(1)});
    expectScattered(ScatterExperiment(maker).run(directionInDegrees(row.out, row.azimuths)),
                    rigorousRow(bubble.medium, row), 0.005);
}

// Only the phase function is sampled here: the constant sky is never picked.
TEST(SingleScattering, UnderAConstantSky) {
    for (const char* name : {"Marble", "Regular Milk"}) {
        SCOPED_TRACE(name);
        SceneMaker maker = halfSpace(measured(name));
        maker.light(EnvironmentLight{Rgb(2), {}, 0});
        const double muO = std::cos(glm::radians(40.0));
        DRgb expected(0);
        for (int c = 0; c < 3; ++c) {
            const ChannelMedium medium =
                maker.world().materialOf(maker.world().bodies()[0]).medium.channel(c);
            expected[c] = 2 * 2 * kPi * testing::integrate01(200, [&](double mu) {
                              return testing::integrate01(100, [&](double phi) {
                                  return rigorous(medium, mu, muO, std::cos(2 * kPi * phi));
                              });
                          });
        }
        expectScattered(ScatterExperiment(maker).run(directionInDegrees(40, 10), 8192), expected,
                        0.01);
    }
}

// A wide light close by: light sampling, weighted against the phase function, gives what the phase
// function alone gives.
TEST(SingleScattering, SamplingALightDoesNotChangeTheMean) {
    for (const char* name : {"Marble", "Regular Milk"}) {
        SCOPED_TRACE(name);
        RectangleLight lamp;
        lamp.centre = {6, kHalfSize + 4, 1};
        lamp.lookAt = {0, kHalfSize, 0};
        lamp.up = {0, 0, 1};
        lamp.widthMm = 9;
        lamp.heightMm = 6;
        lamp.radiance = Rgb(5);
        SceneMaker lit = halfSpace(measured(name));
        lit.light(lamp);
        const World world = lit.world();
        const ScatterExperiment dark(halfSpace(measured(name)));
        const Vec3 wo = directionInDegrees(30, 200);
        const Estimate brute = dark.run(wo, 8192, [&](const Ray& ray, const Vec3& from, float) {
            return world.lights()[0]->seen(from, ray.direction).radiance;
        });
        const Estimate weighted = ScatterExperiment(lit).run(wo);
        for (int c = 0; c < 3; ++c) {
            EXPECT_GT(weighted.mean[c], 0);
            EXPECT_NEAR(weighted.mean[c], brute.mean[c],
                        3 * std::hypot(weighted.error[c], brute.error[c]));
            EXPECT_LT(weighted.error[c], 0.01 * weighted.mean[c]);
            EXPECT_LT(brute.error[c], 0.03 * brute.mean[c]);
        }
    }
}

// Light that would have to pass another object on its way in does not arrive; light from behind
// a thin slab does.
TEST(SingleScattering, ShadowsAndThinSlabs) {
    SceneMaker maker = halfSpace(measured("Marble"));
    maker.light(DirectionalLight{{0, -1, 0}, Rgb(1)});
    maker.object(RectangleShape{20, 20}, maker.material(LambertianMaterial{}),
                 testing::moved({0, kHalfSize + 9, 0}) * testing::turned(90, {1, 0, 0}));
    EXPECT_EQ(ScatterExperiment(maker).run(directionInDegrees(70, 0), 64).mean, DRgb(0));

    // Lit from below, a slab of thickness d: L = alpha sigma_s p ... with both paths in the slab.
    SceneMaker slab;
    const TranslucentMaterial material = testing::grey(0.1, 2, 1.3);
    slab.object(BoxShape{{60, 1, 60}}, slab.material(material),
                testing::moved({0, kHalfSize - 0.5, 0}));
    slab.light(DirectionalLight{{0, 1, 0}, Rgb(1)});
    const double t = 1 - fresnelReflectance(1.0, 1.3);
    const double expected = t * t / (1.3 * 1.3) * 2.0 * std::exp(-2.1) / (4 * kPi);
    expectScattered(ScatterExperiment(slab).run(Vec3(0, 1, 0)), DRgb(expected), 0.01);
}

}  // namespace
}  // namespace sss
