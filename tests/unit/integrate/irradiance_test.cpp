#include "sss/integrate/irradiance.h"

#include "sss/integrate/preprocess.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::integrate01;
using testing::measured;
using testing::moved;
using testing::SceneMaker;
using testing::turned;

constexpr double kMarbleEta = 1.5;

double entering(double cosine) { return 1 - fresnelReflectance(cosine, kMarbleEta); }

struct Lit {
    std::vector<Vec3> positions;  // of the world
    std::vector<Vec3> normals;
    std::vector<Rgb> irradiance;

    // Mean of the red irradiance of the points that face a way.
    double mean(const Vec3& facing) const {
        double sum = 0;
        int n = 0;
        for (std::size_t i = 0; i < normals.size(); ++i)
            if (glm::dot(normals[i], facing) > 0.999f) {
                sum += static_cast<double>(irradiance[i].x);
                ++n;
            }
        EXPECT_GT(n, 10);
        return sum / n;
    }
    double mean() const {
        double sum = 0;
        for (const Rgb& e : irradiance) sum += static_cast<double>(e.x);
        return sum / static_cast<double>(irradiance.size());
    }
};

/// Pass 1's light on body 0, with points `spacing` mm apart.
Lit light(const SceneMaker& maker, double spacing) {
    const World world = maker.world();
    const auto optics = makeBodyOptics(world);
    const PathTracer tracer(world, optics, {});
    SamplerOptions options;
    options.spacingMm = spacing;
    const Body& body = world.bodies().at(0);
    const SurfaceSamples samples = sampleSurface(body.mesh, options);
    SilentReporter silent;
    const IrradianceResult result = computeIrradiance(world, 0, samples, tracer, silent);
    EXPECT_EQ(result.nonFinite, 0u);
    Lit lit;
    lit.irradiance = result.irradiance;
    for (const SurfacePoint& p : samples.points) {
        lit.positions.push_back(Vec3(body.worldFromBody.transformPoint(DVec3(p.position))));
        lit.normals.push_back(
            Vec3(body.worldFromBody.transformDirection(DVec3(decodeUnitVector(p.normal)))));
    }
    return lit;
}

SceneMaker withBox(const DVec3& size, const DMat4& placed = DMat4(1.0)) {
    SceneMaker maker;
    maker.object(BoxShape{size}, maker.material(measured("Marble")), placed);
    maker.scene.quality.irradianceSamples = 64;
    return maker;
}

TEST(Irradiance, OfASphereUnderAConstantSky) {
    SceneMaker maker;
    maker.object(SphereShape{5}, maker.material(measured("Marble")));
    maker.light(EnvironmentLight{Rgb(2, 1, 0.5f), {}, 0});
    maker.scene.quality.irradianceSamples = 256;
    const Lit lit = light(maker, 1);
    const double expected = 2 * kPi * hemisphericalTransmittance(kMarbleEta);
    EXPECT_NEAR(lit.mean(), expected, 5e-4 * expected);
    for (const Rgb& e : lit.irradiance) {
        EXPECT_NEAR(e.x, expected, 0.02 * expected);
        EXPECT_NEAR(e.y, 0.5f * e.x, 1e-4f);
        EXPECT_NEAR(e.z, 0.25f * e.x, 1e-4f);
    }
}

TEST(Irradiance, OfAPlaneUnderTheSun) {
    for (const double degrees : {0.0, 45.0, 80.0}) {
        SceneMaker maker = withBox({10, 10, 10});
        const double t = glm::radians(degrees);
        maker.light(DirectionalLight{{std::sin(t), -std::cos(t), 0}, Rgb(3)});
        const Lit lit = light(maker, 1);
        const double expected = 3 * std::cos(t) * entering(std::cos(t));
        for (std::size_t i = 0; i < lit.normals.size(); ++i) {
            if (lit.normals[i].y > 0.999f) {
                EXPECT_NEAR(lit.irradiance[i].x, expected, 2e-6 * expected);
            }
            if (lit.normals[i].y < -0.999f) {
                EXPECT_EQ(lit.irradiance[i].x, 0);
            }
        }
    }
}

TEST(Irradiance, UnderAPointLight) {
    SceneMaker maker = withBox({0.2, 0.2, 0.2}, moved({0, -0.1, 0}));
    maker.light(PointLight{{3, 4, 0}, Rgb(7)});
    const double cosine = 0.8, metres = 0.005;
    const double expected = 7 * cosine / (metres * metres) * entering(cosine);
    EXPECT_NEAR(light(maker, 0.02).mean({0, 1, 0}), expected, 1e-3 * expected);
}

// A parallel rectangle above a small patch; integrated by the midpoint rule, and without the
// boundary the closed form of the configuration factor.
TEST(Irradiance, UnderARectangle) {
    RectangleLight lamp;
    lamp.centre = {0, 6, 0};
    lamp.up = {0, 0, 1};
    lamp.widthMm = 8;
    lamp.heightMm = 10;
    lamp.radiance = Rgb(2);
    const auto over = [&](const auto& weight) {
        return 80 * integrate01(400, [&](double u) {
                   return integrate01(400, [&](double v) {
                       const double x = 8 * (u - 0.5), z = 10 * (v - 0.5);
                       const double r2 = x * x + z * z + 36, cosine = 6 / std::sqrt(r2);
                       return cosine * cosine / r2 * weight(cosine);
                   });
               });
    };
    // [Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3], four quarters.
    const double a = 4 / 6.0, b = 5 / 6.0;
    const double quarter = (a / std::sqrt(1 + a * a) * std::atan(b / std::sqrt(1 + a * a)) +
                            b / std::sqrt(1 + b * b) * std::atan(a / std::sqrt(1 + b * b))) /
                           (2 * kPi);
    EXPECT_NEAR(over([](double) { return 1.0; }), 4 * quarter * kPi, 1e-4);
    SceneMaker maker = withBox({0.2, 0.2, 0.2}, moved({0, -0.1, 0}));
    maker.light(lamp);
    const double expected = 2 * over(entering);
    EXPECT_NEAR(light(maker, 0.02).mean({0, 1, 0}), expected, 2e-3 * expected);
}

// A black wall at the foot of which the patch lies takes half the sky.
TEST(Irradiance, BehindAnOccluder) {
    SceneMaker maker = withBox({0.1, 0.1, 0.1}, moved({0.06, -0.05, 0}));
    maker.object(RectangleShape{1000, 1000}, maker.material(LambertianMaterial{Rgb(0)}),
                 turned(90, {0, 1, 0}));
    maker.light(EnvironmentLight{Rgb(1), {}, 0});
    const double expected = 0.5 * kPi * hemisphericalTransmittance(kMarbleEta);
    EXPECT_NEAR(light(maker, 0.01).mean({0, 1, 0}), expected, 5e-3 * expected);
}

// All around the same emitting surface, as geometry: the same as a sky.
TEST(Irradiance, InsideAnEmittingSphere) {
    SceneMaker maker = withBox({2, 2, 2});
    maker.object(SphereShape{30}, maker.material(EmitterMaterial{Rgb(1.5f), true}));
    const double expected = 1.5 * kPi * hemisphericalTransmittance(kMarbleEta);
    EXPECT_NEAR(light(maker, 0.2).mean(), expected, 3e-3 * expected);
}

/// A tiny box high over a plane of some material in slanting sunlight: what its underside gets is
/// all by way of the plane, which is lit evenly but for a shadow too small to matter.
SceneMaker overAPlane(const Material& material, double cosSun) {
    SceneMaker maker = withBox({0.1, 0.1, 0.1});
    maker.object(RectangleShape{4000, 4000}, maker.material(material),
                 moved({0, -10, 0}) * turned(-90, {1, 0, 0}));
    maker.light(DirectionalLight{{std::sqrt(1 - cosSun * cosSun), -cosSun, 0}, Rgb(2)});
    return maker;
}

TEST(Irradiance, ByWayOfALambertianPlane) {
    SceneMaker maker = overAPlane(LambertianMaterial{Rgb(0.6f)}, 0.6);
    const double expected = 2 * 0.6 * 0.6 * hemisphericalTransmittance(kMarbleEta);
    EXPECT_NEAR(light(maker, 0.01).mean({0, -1, 0}), expected, 3e-3 * expected);
}

TEST(Irradiance, ByWayOfATranslucentNeighbour) {
    SceneMaker maker = overAPlane(measured("Marble"), 0.6);
    const World world = maker.world();
    const double transmittance = hemisphericalTransmittance(kMarbleEta);
    const double albedo = static_cast<double>(makeBodyOptics(world)[1]->diffuseAlbedo.x);
    const double leaving = 2 * 0.6 * entering(0.6) * albedo / (kPi * transmittance);
    const double expected = leaving * 2 * kPi * integrate01(1000, [](double mu) {
                                return mu * entering(mu) * entering(mu);
                            });
    EXPECT_NEAR(light(maker, 0.01).mean({0, -1, 0}), expected, 3e-3 * expected);
}

TEST(Irradiance, WithoutBouncesIsDirectOnly) {
    SceneMaker maker = overAPlane(LambertianMaterial{Rgb(0.6f)}, 0.6);
    maker.scene.quality.bounces = 0;
    const Lit lit = light(maker, 0.02);
    EXPECT_EQ(lit.mean({0, -1, 0}), 0);
    const double expected = 2 * 0.6 * entering(0.6);
    EXPECT_NEAR(lit.mean({0, 1, 0}), expected, 1e-5 * expected);
}

// The floor is of two triangles a hundred thousand times as large as the step off the surface:
// rays must leave it without meeting it again.
TEST(Irradiance, OfALargeFaceHasNoSpeckles) {
    SceneMaker maker;
    maker.object(BoxShape{{20000, 1, 20000}}, maker.material(measured("Marble")),
                 turned(20, {1, 2, 0.5}));
    maker.light(EnvironmentLight{Rgb(1), {}, 0});
    maker.scene.quality.irradianceSamples = 64;
    const double expected = kPi * hemisphericalTransmittance(kMarbleEta);
    for (const Rgb& e : light(maker, 800).irradiance) EXPECT_NEAR(e.x, expected, 0.05 * expected);
}

}  // namespace
}  // namespace sss
