#include "sss/optics/microsurface.h"

#include "sss/optics/fresnel.h"
#include "support/directions.h"

#include <gtest/gtest.h>

#include <array>

namespace sss {
namespace {

using testing::direction;

struct Mean {
    double value = 0, error = 0;
};
template <typename F>
Mean meanOf(std::uint64_t seed, std::uint32_t n, const F& f) {
    double sum = 0, squares = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        Sampler sampler(combineSeeds(seed, i), 0);  // independent of each other
        const auto x = static_cast<double>(f(sampler));
        sum += x;
        squares += x * x;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
}

void expectEqual(const Mean& a, const Mean& b, double largestError) {
    const double error = std::hypot(a.error, b.error);
    EXPECT_NEAR(a.value, b.value, 4 * error);
    EXPECT_LT(error, largestError);
}

struct Case {
    float roughness, eta;
    double cosine;
};
constexpr std::array kCases{Case{0.3f, 1.5f, 0.9}, Case{0.6f, 1.5f, 0.5}, Case{0.6f, 0.67f, 0.9},
                            Case{1.0f, 0.67f, 0.3}, Case{1.0f, 1.33f, 0.1}};

// Height-correlated masking of both sides [Walter et al. 2007; Heitz et al. 2016, Eqs. 8 and 9],
// which the walk knows nothing of.
double maskingBeyond(const Ggx& ggx, const Vec3& wo, const Vec3& wi) {
    const double a = 1 / static_cast<double>(ggx.masking(wo)),
                 b = 1 / static_cast<double>(ggx.masking(wi));
    return std::exp(std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b));
}

// What leaves after one microfacet, by quadrature over the visible normals' density.
double onceByQuadrature(const Case& c, bool isReflected) {
    const Ggx ggx(c.roughness);
    const DVec3 wo(direction(c.cosine, 0.3));
    const double alpha = static_cast<double>(ggx.alpha()), eta = static_cast<double>(c.eta);
    constexpr int kRings = 400, kSectors = 200;
    double sum = 0;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            const double t = (i + 0.5) / kRings, tangent = alpha * t / (1 - t);
            const double z = 1 / std::sqrt(1 + tangent * tangent);
            const double solidAngle = tangent * z * z * z * alpha / ((1 - t) * (1 - t)) * 2 * kPi /
                                      (kRings * static_cast<double>(kSectors));
            const DVec3 h(direction(z, 2 * kPi * (j + 0.5) / kSectors));
            const double cosine = glm::dot(wo, h);
            if (!(cosine > 0)) continue;
            const double fresnel = fresnelReflectance(cosine, eta);
            const double beyond = refractedCosine(cosine, eta);
            const DVec3 out =
                isReflected ? 2 * cosine * h - wo : -wo / eta + h * (cosine / eta - beyond);
            if (isReflected != (out.z > 0)) continue;
            const Vec3 a(wo), b(isReflected ? out : DVec3(out.x, out.y, -out.z));
            const double both = isReflected ? static_cast<double>(ggx.maskingShadowing(a, b))
                                            : maskingBeyond(ggx, a, b);
            // Weighted by what masks both ways over what masks the one [Heitz 2018].
            sum += solidAngle * static_cast<double>(ggx.visibleNormalPdf(a, Vec3(h))) * both /
                   static_cast<double>(ggx.masking(a)) * (isReflected ? fresnel : 1 - fresnel);
        }
    return sum;
}

TEST(Microsurface, OneMicrofacetAsByWalter) {
    for (const Case& c : kCases)
        for (const bool isReflected : {true, false}) {
            SCOPED_TRACE(::testing::Message() << c.roughness << ' ' << c.eta << ' ' << c.cosine);
            const Microsurface surface(Ggx(c.roughness), c.eta);
            const Vec3 wo = direction(c.cosine, 0.3);
            const Mean walked = meanOf(1, 40000, [&](Sampler& sampler) {
                const Microsurface::Exit exit = surface.sample(wo, sampler);
                return exit.scatterings == 1 && isReflected == (exit.direction.z > 0) ? 1.0 : 0.0;
            });
            expectEqual(walked, {onceByQuadrature(c, isReflected), 5e-4}, 0.004);
        }
}

// Cell by cell, on both sides; so that the density integrates to 1 as well.
TEST(Microsurface, SamplesFollowTheirDensity) {
    constexpr int kRings = 4, kSectors = 3, kCells = 2 * kRings * kSectors;
    const auto cellOf = [](const Vec3& w) {
        const int ring = std::clamp(static_cast<int>((w.z + 1) * kRings), 0, 2 * kRings - 1);
        const float azimuth = std::atan2(w.y, w.x) / (2 * kPiF) + 0.5f;
        return ring * kSectors + std::min(kSectors - 1, static_cast<int>(azimuth * kSectors));
    };
    for (const Case& c : kCases) {
        SCOPED_TRACE(::testing::Message() << c.roughness << ' ' << c.eta << ' ' << c.cosine);
        const Microsurface surface(Ggx(c.roughness), c.eta);
        const Vec3 wo = direction(c.cosine, 0.3);
        constexpr int n = 40000;
        std::array<double, kCells> sampled{}, sum{}, squares{};
        for (int i = 0; i < n; ++i) {
            Sampler sampler(combineSeeds(5, static_cast<std::uint64_t>(i)), 0);
            const Vec3 out = surface.sample(wo, sampler).direction;
            ASSERT_NEAR(glm::length(out), 1, 1e-5);
            sampled[static_cast<std::size_t>(cellOf(out))] += 1.0 / n;
            const Vec2 u = sampler.next2D();
            const Vec3 wi =
                direction(2 * static_cast<double>(u.x) - 1, 2 * kPi * static_cast<double>(u.y));
            const double density = 4 * kPi * static_cast<double>(surface.density(wo, wi, sampler));
            const auto cell = static_cast<std::size_t>(cellOf(wi));
            sum[cell] += density / n;
            squares[cell] += density * density / n;
        }
        double total = 0;
        for (std::size_t k = 0; k < kCells; ++k) {
            const double variance = squares[k] - sum[k] * sum[k] + sampled[k] * (1 - sampled[k]);
            EXPECT_NEAR(sampled[k], sum[k], 4 * std::sqrt(variance / n) + 1e-4) << "cell " << k;
            total += sum[k];
        }
        EXPECT_NEAR(total, 1, c.roughness > 0.5f ? 0.03 : 0.15);  // sharp lobes are rarely met
    }
}

// f(a, b) / n_b^2 = f(b, a) / n_a^2, whichever sides these are on.
TEST(Microsurface, IsReciprocal) {
    const Ggx ggx(1);
    const float eta = 1.5f;
    const auto estimate = [&](const Vec3& from, const Vec3& to) {
        const bool isInside = from.z < 0;
        const Microsurface surface(ggx, isInside ? 1 / eta : eta);
        const float side = isInside ? -1.0f : 1.0f, n = to.z < 0 ? eta : 1.0f;
        const float scale = 1 / (std::abs(to.z) * n * n);
        return meanOf(3, 30000, [&](Sampler& sampler) {
            return scale * surface.density({from.x, from.y, side * from.z},
                                           {to.x, to.y, side * to.z}, sampler);
        });
    };
    // Grazing, steep, and both below.
    const Vec3 low = direction(0.15, 3), lower = direction(0.1, 0.1), above = direction(0.8, 0.2),
               below = direction(-0.9, 3.5), deep = direction(-0.4, 5);
    for (const auto& [a, b] : {std::pair{low, lower}, std::pair{above, below},
                               std::pair{low, below}, std::pair{below, deep}}) {
        const Mean there = estimate(a, b), back = estimate(b, a);
        expectEqual(there, back, 0.08 * back.value);
    }
}

TEST(Microsurface, TendsToTheSmoothOne) {
    const Ggx ggx(0.0101f);
    ASSERT_FALSE(ggx.isSpecular());
    for (const float eta : {1.5f, 1 / 1.5f})
        for (const double cosine : {0.9, 0.4}) {
            const Vec3 wo = direction(cosine, 1);
            const Microsurface surface(ggx, eta);
            const Mean reflected = meanOf(7, 4000, [&](Sampler& sampler) {
                const Vec3 out = surface.sample(wo, sampler).direction;
                const Vec3 expected =
                    out.z > 0 ? Vec3(-wo.x, -wo.y, wo.z)
                              : Vec3(-wo.x / eta, -wo.y / eta, -refractedCosine(wo.z, eta));
                // The tail of GGX is long.
                return glm::distance(out, expected) < 0.02f ? (out.z > 0 ? 1.0 : 0.0) : 1e3;
            });
            const auto share = static_cast<double>(fresnelReflectance(wo.z, eta));
            EXPECT_NEAR(reflected.value, share, 4 * reflected.error + 1e-3);
            EXPECT_LT(reflected.error, 0.01);
        }
}

}  // namespace
}  // namespace sss
