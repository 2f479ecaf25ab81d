#pragma once
#include "sss/base/sampler.h"
#include "sss/optics/microfacet.h"

namespace sss {

/// A rough dielectric boundary that loses no light: GGX microfacets reflect and refract by Fresnel
/// and Snell [Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"], and
/// what one of them sends to another goes on from there [Heitz et al. 2016, "Multiple-Scattering
/// Microfacet BSDFs with the Smith Model"], as often as it takes. Local frame, z = the macroscopic
/// normal on the side from where the path comes; directions are unit vectors away from the surface.
class Microsurface {
public:
    /// `eta` = index beyond / index on the side of z > 0. `ggx` not specular.
    Microsurface(const Ggx& ggx, float eta) : ggx_(ggx), eta_(eta) {}

    struct Exit {
        Vec3 direction{};     ///< z > 0 if it has come back, z < 0 beyond
        int scatterings = 0;  ///< by microfacets
    };
    /// Where a path that arrives from `wo` (z > 0) leaves. All of it does: its weight stays what it
    /// is, but for the eta^2 of radiance beyond.
    Exit sample(const Vec3& wo, Sampler& sampler) const;

    /// An estimate without bias of the density (sr^-1) of `wi`, on either side, in sample(wo).
    float density(const Vec3& wo, const Vec3& wi, Sampler& sampler) const;

private:
    Ggx ggx_;
    float eta_;
};

}  // namespace sss
