#include "sss/integrate/bsdf.h"

#include "sss/integrate/preprocess.h"
#include "sss/medium/albedo_inversion.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::integrate01;
using testing::measured;
using testing::SceneMaker;

struct Case {
    const char* name;
    Material material;
    Bsdf::BodyShading shading = Bsdf::BodyShading::Surface;
};

std::vector<Case> cases() {
    TranslucentMaterial coated = measured("Marble");
    coated.roughness = 0.5;
    MetalMaterial metal;
    metal.roughness = 0.6;
    return {{"lambertian", LambertianMaterial{Rgb(0.9f, 0.5f, 0.1f)}},
            {"metal", metal},
            {"coat", coated},
            {"diffuse limit", measured("Marble"), Bsdf::BodyShading::DiffuseLimit}};
}

/// The BSDF of a material on the upper side of the x-y plane.
class OnAPlane {
public:
    explicit OnAPlane(const Case& c) : case_(c), world_(make(c)), optics_(makeBodyOptics(world_)) {}

    Bsdf at(const Vec3& wo) const {
        Ray ray;
        ray.origin = wo;
        ray.direction = -wo;
        Hit hit;
        EXPECT_TRUE(world_.rays().intersect(ray, hit));
        return Bsdf(world_, world_.surfaceAt(hit), wo, optics_.empty() ? nullptr : optics_[0].get(),
                    case_.shading);
    }

private:
    static World make(const Case& c) {
        SceneMaker maker;
        maker.object(RectangleShape{30, 20}, maker.material(c.material));
        return maker.world();
    }
    Case case_;
    World world_;
    std::vector<std::unique_ptr<BodyOptics>> optics_;
};

Vec3 inclined(double cosine, double phi) {
    const double s = std::sqrt(1 - cosine * cosine);
    return Vec3(DVec3(s * std::cos(phi), s * std::sin(phi), cosine));
}

// Over the upper hemisphere, by the midpoint rule in (cos, phi).
template <typename F>
double overHemisphere(const F& f) {
    return 2 * kPi * integrate01(300, [&](double mu) {
               return integrate01(300, [&](double t) { return f(inclined(mu, 2 * kPi * t)); });
           });
}

TEST(Bsdf, DensitiesIntegrateToWhatIsSampled) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const OnAPlane plane(c);
        for (const double cosine : {0.95, 0.4}) {
            const Bsdf bsdf = plane.at(inclined(cosine, 0.7));
            const double total =
                overHemisphere([&](const Vec3& wi) { return bsdf.evaluate(wi).pdf; });
            int alive = 0;
            constexpr int kSamples = 1 << 14;
            for (std::uint32_t i = 0; i < kSamples; ++i)
                alive += bsdf.sample(Sampler(3, i).next2D()).pdf > 0 ? 1 : 0;
            EXPECT_LE(total, 1 + 2e-3);
            EXPECT_NEAR(total, static_cast<double>(alive) / kSamples, 5e-3);
        }
    }
}

TEST(Bsdf, SamplesAgreeWithValuesAndDensities) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const OnAPlane plane(c);
        const Bsdf bsdf = plane.at(inclined(0.6, 2.1));
        ASSERT_TRUE(bsdf.hasSmoothPart());
        for (std::uint32_t i = 0; i < 500; ++i) {
            const Bsdf::Sample s = bsdf.sample(Sampler(3, i).next2D());
            if (!(s.pdf > 0)) continue;
            EXPECT_FALSE(s.isDelta);
            EXPECT_NEAR(bsdf.evaluate(s.wi).pdf, s.pdf, 2e-3f * s.pdf);
            const Rgb expected = bsdf.evaluate(s.wi).value / s.pdf;
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(s.weight[k], expected[k], 3e-3f);
        }
    }
}

// What is sampled, on average, is the integral; and no more comes back than arrives.
TEST(Bsdf, EnergyIsKept) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const OnAPlane plane(c);
        for (const double cosine : {1.0, 0.7, 0.2}) {
            const Bsdf bsdf = plane.at(inclined(cosine, 4.0));
            DRgb mean(0);
            constexpr std::uint32_t kSamples = 1 << 14;
            for (std::uint32_t i = 0; i < kSamples; ++i) {
                const Bsdf::Sample s = bsdf.sample(Sampler(5, i).next2D());
                if (s.pdf > 0) mean += DRgb(s.weight) / static_cast<double>(kSamples);
            }
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(mean[k], overHemisphere([&](const Vec3& wi) {
                                return bsdf.evaluate(wi).value[k];
                            }),
                            3e-3);
                EXPECT_LE(mean[k], 1);
            }
        }
    }
}

// The diffuse limit and the smooth reflection of one boundary share what arrives.
TEST(Bsdf, WhatLeavesABodyIsAllThatIsLeft) {
    const World world = [] {
        SceneMaker maker;
        maker.object(BoxShape{DVec3(4)}, maker.material(testing::grey(0, 5, 1.4)));
        return maker.world();
    }();
    const auto optics = makeBodyOptics(world);
    EXPECT_NEAR(optics[0]->diffuseAlbedo.x, 1, 1e-5);
    // Radiance per exitance integrates to the exitance.
    const double flux =
        2 * kPi * integrate01(20000, [&](double mu) {
            return mu * static_cast<double>(optics[0]->radiancePerExitance(static_cast<float>(mu)));
        });
    EXPECT_NEAR(flux, 1, 1e-5);
}

TEST(Bsdf, MirrorsReflect) {
    MetalMaterial metal;
    metal.roughness = 0;
    TranslucentMaterial glazed = measured("Marble");
    for (const Case& c : {Case{"metal", metal}, Case{"coat", glazed}}) {
        SCOPED_TRACE(c.name);
        const OnAPlane plane(c);
        const Vec3 wo = inclined(0.5, 1.0);
        const Bsdf bsdf = plane.at(wo);
        EXPECT_FALSE(bsdf.hasSmoothPart());
        const Bsdf::Sample s = bsdf.sample({0.3f, 0.8f});
        EXPECT_TRUE(s.isDelta);
        EXPECT_LT(glm::length(s.wi - Vec3(-wo.x, -wo.y, wo.z)), 1e-5f);
        EXPECT_EQ(bsdf.evaluate(s.wi).value, Rgb(0));
        EXPECT_EQ(bsdf.evaluate(s.wi).pdf, 0);
        EXPECT_LT(s.weight.x, 1);
        EXPECT_GT(s.weight.x, 0);
    }
}

TEST(Bsdf, BodiesWithoutReflectionAndEmittersAreBlack) {
    TranslucentMaterial bare = measured("Marble");
    bare.surfaceReflection = false;
    for (const Case& c : {Case{"bare", bare}, Case{"emitter", EmitterMaterial{}}}) {
        SCOPED_TRACE(c.name);
        const OnAPlane plane(c);
        const Bsdf bsdf = plane.at(inclined(0.8, 0.1));
        EXPECT_TRUE(bsdf.isBlack());
        EXPECT_EQ(bsdf.sample({0.5f, 0.5f}).pdf, 0);
        EXPECT_EQ(bsdf.evaluate({0, 0, 1}).value, Rgb(0));
    }
}

// With single scattering there is something to share; without, the profile is its paper's, and a
// medium made from a colour still returns that colour, however dark.
TEST(BodyOptics, ScalesDiffusionOnlyBesideSingleScattering) {
    TranslucentMaterial marble = measured("Marble");
    const BodyOptics both(marble);
    marble.singleScattering = false;
    const BodyOptics alone(marble);
    EXPECT_EQ(alone.multipleScale, Rgb(1));
    TranslucentMaterial dark;
    dark.diffuseColor = DRgb(0.02);
    const ChannelMedium channel = invertAlbedo("dipole", {0.02, 1});
    dark.medium = {DRgb(channel.sigmaA), DRgb(channel.sigmaS), DRgb(0), channel.eta};
    const BodyOptics shared(dark);
    dark.singleScattering = false;
    const BodyOptics whole(dark);
    for (int c = 0; c < 3; ++c) {
        EXPECT_GT(both.multipleScale[c], 0.9f);
        EXPECT_LT(both.multipleScale[c], 1.0f);
        EXPECT_LT(shared.multipleScale[c], 0.7f);  // most of so dark a color is scattered once
        EXPECT_NEAR(static_cast<double>(whole.multipleScale[c]) *
                        whole.profiles[static_cast<std::size_t>(c)]->total(),
                    0.02, 1e-8);
    }
}

}  // namespace
}  // namespace sss
