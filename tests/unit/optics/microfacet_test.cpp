#include "sss/optics/microfacet.h"

#include "sss/base/rng.h"
#include "sss/base/sampler.h"
#include "sss/optics/fresnel.h"
#include "support/directions.h"

#include <gtest/gtest.h>

#include <vector>

namespace sss {
namespace {

using testing::direction;

/// Integral of f over the upper hemisphere: midpoint rule, in tan(theta) = alpha t / (1 - t) so
/// that a lobe of width alpha about the normal is resolved.
template <typename F>
double integrateAboutNormal(double alpha, const F& f) {
    const int rings = 800, sectors = 128;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double t = (i + 0.5) / rings;
        const double tangent = alpha * t / (1 - t), slope = alpha / ((1 - t) * (1 - t));
        const double cosine = 1 / std::sqrt(1 + tangent * tangent);
        // sin dtheta = sin cos^2 dtan
        const double weight = tangent * cosine * cosine * cosine * slope;
        for (int j = 0; j < sectors; ++j)
            sum +=
                weight * static_cast<double>(f(direction(cosine, 2 * kPi * (j + 0.5) / sectors)));
    }
    return sum * 2 * kPi / (rings * static_cast<double>(sectors));
}

/// The same, uniform in the solid angle: for the lobes of rough surfaces.
template <typename F>
double integrateHemisphere(const F& f) {
    const int rings = 600, sectors = 600;
    double sum = 0;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sectors; ++j)
            sum +=
                static_cast<double>(f(direction((i + 0.5) / rings, 2 * kPi * (j + 0.5) / sectors)));
    return sum * 2 * kPi / (rings * static_cast<double>(sectors));
}

const std::vector<float> kRoughness{0.05f, 0.3f, 0.6f, 1.0f};
const std::vector<double> kCosines{1.0, 0.7, 0.25, 0.05};

TEST(Microfacet, ProjectedAreaOfTheNormalsIsOne) {
    for (const float roughness : kRoughness) {
        const Ggx ggx(roughness);
        EXPECT_NEAR(integrateAboutNormal(static_cast<double>(ggx.alpha()),
                                         [&](const Vec3& h) { return ggx.normalDensity(h) * h.z; }),
                    1, 1e-4)
            << roughness;
    }
}

TEST(Microfacet, VisibleNormalsAreAProbabilityDensity) {
    // Also Smith's condition: the visible projected area is the cosine [Heitz 2014, eq. 14].
    for (const float roughness : {0.3f, 0.6f, 1.0f})
        for (const double cosine : kCosines) {
            const Ggx ggx(roughness);
            const Vec3 wo = direction(cosine, 0.4);
            const double total =
                integrateAboutNormal(static_cast<double>(ggx.alpha()),
                                     [&](const Vec3& h) { return ggx.visibleNormalPdf(wo, h); });
            EXPECT_NEAR(total, 1, 2e-3) << roughness << " " << cosine;
        }
}

TEST(Microfacet, SampledNormalsFollowTheirDensity) {
    // Chi-square in cells of (t, azimuth), tan(theta) = alpha t / (1 - t).
    const int rings = 12, sectors = 12, fine = 24, n = 60000;
    for (const float roughness : {0.1f, 0.5f, 1.0f})
        for (const double cosine : {0.95, 0.3}) {
            const Ggx ggx(roughness);
            const double alpha = static_cast<double>(ggx.alpha());
            const Vec3 wo = direction(cosine, 0.4);
            std::vector<double> expected(rings * sectors, 0.0), counts(rings * sectors, 0.0);
            for (int i = 0; i < rings * fine; ++i)
                for (int j = 0; j < sectors * fine; ++j) {
                    const double t = (i + 0.5) / (rings * fine);
                    const double tangent = alpha * t / (1 - t);
                    const double c = 1 / std::sqrt(1 + tangent * tangent);
                    const double weight = tangent * c * c * c * alpha / ((1 - t) * (1 - t)) * 2 *
                                          kPi / (rings * fine * sectors * fine);
                    const Vec3 h = direction(c, 2 * kPi * (j + 0.5) / (sectors * fine));
                    expected[static_cast<std::size_t>(i / fine * sectors + j / fine)] +=
                        n * weight * static_cast<double>(ggx.visibleNormalPdf(wo, h));
                }
            Rng rng(17);
            for (int s = 0; s < n; ++s) {
                const Vec3 h = ggx.sampleVisibleNormal(wo, rng.uniform2());
                ASSERT_NEAR(glm::length(h), 1, 1e-5);
                const double tangent =
                    std::hypot(static_cast<double>(h.x), static_cast<double>(h.y)) /
                    std::max(1e-9, static_cast<double>(h.z)) / alpha;
                double azimuth = std::atan2(static_cast<double>(h.y), static_cast<double>(h.x));
                if (azimuth < 0) azimuth += 2 * kPi;
                const int i =
                    std::min(rings - 1, static_cast<int>(tangent / (1 + tangent) * rings));
                const int j =
                    std::min(sectors - 1, static_cast<int>(azimuth / (2 * kPi) * sectors));
                ++counts[static_cast<std::size_t>(i * sectors + j)];
            }
            double chi2 = 0, rareExpected = 0, rareCount = 0;
            int cells = 0;
            for (std::size_t k = 0; k < counts.size(); ++k) {
                if (expected[k] < 5) {
                    rareExpected += expected[k];
                    rareCount += counts[k];
                    continue;
                }
                ++cells;
                chi2 += (counts[k] - expected[k]) * (counts[k] - expected[k]) / expected[k];
            }
            // 4 standard deviations of the chi-square distribution.
            EXPECT_LT(chi2, cells + 4 * std::sqrt(2.0 * cells)) << roughness << " " << cosine;
            EXPECT_NEAR(rareCount, rareExpected, 5 * std::sqrt(rareExpected + 1));
        }
}

TEST(Microfacet, ReflectionIsReciprocal) {
    Rng rng(2);
    const Ggx ggx(0.5f);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 a = direction(rng.uniformDouble(), 6 * rng.uniformDouble());
        const Vec3 b = direction(rng.uniformDouble(), 6 * rng.uniformDouble());
        EXPECT_NEAR(ggx.reflection(a, b), ggx.reflection(b, a), 1e-5f * ggx.reflection(a, b));
    }
}

TEST(Microfacet, FurnaceNeverGainsAndSamplingAgreesWithQuadrature) {
    for (const float roughness : {0.4f, 0.7f, 1.0f})
        for (const double cosine : kCosines) {
            const Ggx ggx(roughness);
            const Vec3 wo = direction(cosine, 0.4);
            const double reflectance =
                integrateHemisphere([&](const Vec3& wi) { return ggx.reflection(wo, wi) * wi.z; });
            const double kept =
                integrateHemisphere([&](const Vec3& wi) { return ggx.reflectionPdf(wo, wi); });
            double sampled = 0, above = 0;
            const std::uint32_t n = 1 << 14;
            for (std::uint32_t i = 0; i < n; ++i) {
                // k = huge: a perfect mirror, so that the lobe alone is tested.
                const ReflectionSample s =
                    sampleConductor(ggx, wo, Sampler(3, i).next2D(), {Rgb{1.0f}, Rgb{1e6f}});
                EXPECT_LE(maxComponent(s.weight), 1.0f + 1e-6f);
                sampled += static_cast<double>(s.weight.x) / n;
                above += (s.pdf > 0 ? 1.0 : 0.0) / n;
            }
            EXPECT_LE(reflectance, 1.0 + 1e-3);
            EXPECT_NEAR(sampled, reflectance, 4e-3) << roughness << " " << cosine;
            EXPECT_NEAR(above, kept, 4e-3) << roughness << " " << cosine;
        }
}

TEST(Microfacet, WeightIsValueTimesCosineOverDensity) {
    const ConductorIndex gold{{0.143f, 0.375f, 1.442f}, {3.983f, 2.386f, 1.603f}};
    Rng rng(8);
    for (const float roughness : kRoughness)
        for (int i = 0; i < 500; ++i) {
            const Ggx ggx(roughness);
            const Vec3 wo = direction(0.02 + 0.98 * rng.uniformDouble(), 6 * rng.uniformDouble());
            const Vec2 u = rng.uniform2();
            const ReflectionSample metal = sampleConductor(ggx, wo, u, gold);
            const ReflectionSample glass = sampleDielectricReflection(ggx, wo, u, 1.5f);
            EXPECT_EQ(metal.pdf, glass.pdf);
            if (metal.pdf == 0) continue;
            EXPECT_EQ(metal.pdf, ggx.reflectionPdf(wo, metal.wi));
            const Ggx::Lobe lobe = ggx.lobe(wo, metal.wi);
            EXPECT_NEAR(lobe.share, ggx.maskingShadowing(wo, metal.wi) / ggx.masking(wo),
                        1e-6f * lobe.share);
            const Rgb value = lobe.value * conductorFresnel(lobe.cosine, gold);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(value[c] * metal.wi.z / metal.pdf, metal.weight[c],
                            1e-3f * metal.weight[c] + 1e-6f);
            EXPECT_NEAR(lobe.value * fresnelReflectance(lobe.cosine, 1.5f) * glass.wi.z / glass.pdf,
                        glass.weight.x, 1e-3f * glass.weight.x + 1e-6f);
        }
}

TEST(Microfacet, SmoothSurfacesAreMirrors) {
    const Ggx mirror(0.0099f);
    ASSERT_TRUE(mirror.isSpecular());
    EXPECT_FALSE(Ggx(0.0101f).isSpecular());
    const Vec3 wo = direction(0.6, 1.0);
    const ReflectionSample s = sampleDielectricReflection(mirror, wo, {0.3f, 0.9f}, 1.5f);
    EXPECT_TRUE(s.isDelta);
    EXPECT_EQ(s.wi, Vec3(-wo.x, -wo.y, wo.z));
    EXPECT_EQ(s.pdf, 1.0f);
    EXPECT_EQ(s.weight.x, fresnelReflectance(wo.z, 1.5f));
    EXPECT_EQ(mirror.reflection(wo, s.wi), 0.0f);
    EXPECT_EQ(mirror.reflectionPdf(wo, s.wi), 0.0f);
}

TEST(Microfacet, NothingBelowTheSurface) {
    const Ggx ggx(0.5f);
    const Vec3 up = direction(0.5, 0), down{up.x, up.y, -up.z};
    EXPECT_EQ(ggx.reflection(up, down), 0.0f);
    EXPECT_EQ(ggx.reflectionPdf(down, up), 0.0f);
    EXPECT_EQ(sampleConductor(ggx, down, {0.5f, 0.5f}, {}).pdf, 0.0f);
}

}  // namespace
}  // namespace sss
