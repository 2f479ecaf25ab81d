#pragma once
#include "sss/base/vec.h"

namespace sss {

// Rough boundaries after Cook and Torrance. Everything is in the local frame, z = the macroscopic
// normal; `wo` and `wi` are unit vectors away from the surface, on the side z > 0 (elsewhere values
// and densities are 0). Values are BRDFs in sr^-1, without the cosine.

/// The isotropic GGX (Trowbridge-Reitz) distribution with Smith's masking [Walter et al. 2007;
/// Heitz 2014, "Understanding the Masking-Shadowing Function"].
class Ggx {
public:
    /// `roughness` in [0, 1]; alpha = roughness^2.
    explicit Ggx(float roughness) : alpha_(roughness * roughness) {}

    float alpha() const { return alpha_; }
    /// So smooth that it is a mirror: every value and density below is 0, and the caller reflects.
    bool isSpecular() const { return alpha_ < 1e-4f; }

    /// Density of microfacet normals, per area and solid angle: the integral of D cos is 1.
    float normalDensity(const Vec3& h) const;
    /// Smith's masking of one direction, in (0, 1].
    float masking(const Vec3& w) const { return 1.0f / (1.0f + lambda(w)); }
    /// Height-correlated masking and shadowing [Heitz 2014, eq. 99].
    float maskingShadowing(const Vec3& wo, const Vec3& wi) const {
        return 1.0f / (1.0f + lambda(wo) + lambda(wi));
    }
    /// Area of the microfacets that look towards a direction, seen from there, per area of the
    /// surface: its cosine over its masking, and, for directions below the horizon, what looks that
    /// way [Heitz et al. 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model"]. That
    /// of w less that of -w is the cosine of w.
    float visibleArea(const Vec3& w) const;
    /// A microfacet normal among those visible from `wo`, which may be below the horizon [Heitz
    /// 2018, "Sampling the GGX Distribution of Visible Normals"].
    Vec3 sampleVisibleNormal(const Vec3& wo, const Vec2& u) const;
    /// Its density in solid angle (sr^-1).
    float visibleNormalPdf(const Vec3& wo, const Vec3& h) const;

    /// What is known of a pair of directions once their half vector is.
    struct Lobe {
        float value = 0;   ///< the reflection lobe with a Fresnel factor of 1: D G2 / (4 cos cos)
        float pdf = 0;     ///< see reflectionPdf()
        float share = 0;   ///< value x cos wi / pdf = G2 / G1(wo) [Heitz 2018, eq. 19]
        float cosine = 0;  ///< of either direction to the half vector
    };
    /// All zero if specular.
    Lobe lobe(const Vec3& wo, const Vec3& wi) const;
    /// Density (sr^-1) of `wi` when `wo` is reflected by a sampled visible normal. It integrates to
    /// less than 1 over the hemisphere: the rest goes below the surface, and is lost.
    float reflectionPdf(const Vec3& wo, const Vec3& wi) const { return lobe(wo, wi).pdf; }
    float reflection(const Vec3& wo, const Vec3& wi) const { return lobe(wo, wi).value; }

private:
    float lambda(const Vec3& w) const;
    float alpha_;
};

/// `wo` mirrored about `h`.
inline Vec3 mirrored(const Vec3& wo, const Vec3& h) { return 2.0f * glm::dot(wo, h) * h - wo; }

/// Complex index of refraction eta + i k of a conductor, per channel.
struct ConductorIndex {
    Rgb eta{0.2f, 0.92f, 1.1f};
    Rgb k{3.9f, 2.45f, 2.14f};
};

/// Fresnel reflectance of a conductor, per channel: what its lobe is multiplied by.
Rgb conductorFresnel(float cosine, const ConductorIndex& index);

/// A reflected direction. A specular surface gives the mirror direction with pdf 1 and isDelta.
struct ReflectionSample {
    Vec3 wi{0.0f};
    Rgb weight{0.0f};      ///< BRDF cos / pdf, Fresnel included; at most 1
    float pdf = 0;         ///< sr^-1; 0 = nothing is reflected this way
    bool isDelta = false;  ///< no other technique can find this direction
};
ReflectionSample sampleConductor(const Ggx& ggx, const Vec3& wo, const Vec2& u,
                                 const ConductorIndex& index);
ReflectionSample sampleDielectricReflection(const Ggx& ggx, const Vec3& wo, const Vec2& u,
                                            float eta);

}  // namespace sss
