#include "sss/integrate/bsdf.h"

#include "sss/base/warp.h"
#include "sss/integrate/half_space_single.h"
#include "sss/optics/fresnel.h"

#include <algorithm>

namespace sss {
namespace {

constexpr float kGrazing = 1e-4f;
constexpr float kIndirectRoughness = 0.5f;

Vec3 towards(const Vec3& n, const Vec3& side) { return glm::dot(n, side) < 0 ? -n : n; }

// The interpolated normal on the side of wo, or the face's where the interpolated one looks away.
Vec3 usableShadingNormal(const SurfaceHit& hit, const Vec3& geometric, const Vec3& wo) {
    const Vec3 shading = towards(hit.shadingNormal, geometric);
    return glm::dot(shading, wo) > kGrazing ? shading : geometric;
}

}  // namespace

Bsdf::Bsdf(const World& world, const SurfaceHit& hit, const Vec3& wo, const BodyOptics* optics,
           BodyShading shading)
    : geometricNormal_(towards(hit.geometricNormal, wo)),
      frame_(usableShadingNormal(hit, geometricNormal_, wo)),
      woLocal_(frame_.toLocal(wo)),
      optics_(optics) {
    woLocal_.z = std::max(woLocal_.z, kGrazing);
    const Material& material = world.material(hit.material);
    if (const auto* lambertian = std::get_if<LambertianMaterial>(&material)) {
        kind_ = Kind::Diffuse;
        albedo_ = lambertian->reflectance;
    } else if (const auto* metal = std::get_if<MetalMaterial>(&material)) {
        kind_ = Kind::Conductor;
        ggx_ = Ggx(static_cast<float>(metal->roughness));
        index_ = {metal->eta, metal->k};
        albedo_ = conductorFresnel(woLocal_.z, index_);
    } else if (const auto* translucent = std::get_if<TranslucentMaterial>(&material)) {
        albedo_ = optics->diffuseAlbedo;
        if (shading == BodyShading::DiffuseLimit) {
            kind_ = Kind::DiffuseLimit;
        } else if (shading == BodyShading::ScatteredOnce) {
            kind_ = Kind::ScatteredOnce;
        } else if (shading == BodyShading::Lambertian) {
            kind_ = Kind::Diffuse;
        } else if (translucent->surfaceReflection && optics->eta != 1.0f) {
            kind_ = Kind::Coat;
            ggx_ = Ggx(static_cast<float>(translucent->roughness));
        }
    }
}

void Bsdf::roughenForIndirect() {
    const Ggx widest(kIndirectRoughness);
    if (ggx_.alpha() < widest.alpha()) ggx_ = widest;
}

bool Bsdf::hasSmoothPart() const {
    switch (kind_) {
        case Kind::Black:
            return false;
        case Kind::Diffuse:
        case Kind::DiffuseLimit:
        case Kind::ScatteredOnce:
            return true;
        case Kind::Conductor:
        case Kind::Coat:
            return !ggx_.isSpecular();
    }
    return false;
}

// The kinds whose light is looked for all over the hemisphere.
bool Bsdf::isWide() const {
    return kind_ == Kind::Diffuse || kind_ == Kind::DiffuseLimit || kind_ == Kind::ScatteredOnce;
}

// BRDF of these.
Rgb Bsdf::wideValue(const Vec3& wiLocal) const {
    if (kind_ == Kind::Diffuse) return albedo_ * (1.0f / kPiF);
    if (kind_ == Kind::ScatteredOnce)
        return halfSpaceSingleScattering(MediumCoefficients(optics_->material.medium), optics_->eta,
                                         woLocal_, wiLocal);
    const float entering = 1.0f - fresnelReflectance(wiLocal.z, optics_->eta);
    return albedo_ * (entering * optics_->radiancePerExitance(woLocal_.z));
}

Bsdf::Value Bsdf::evaluate(const Vec3& wi) const {
    const Vec3 wiLocal = frame_.toLocal(wi);
    if (kind_ == Kind::Black || wiLocal.z <= 0) return {};
    const bool isOutside = glm::dot(wi, geometricNormal_) > 0;
    if (isWide()) return {isOutside ? wideValue(wiLocal) * wiLocal.z : Rgb(0), wiLocal.z / kPiF};
    const Ggx::Lobe lobe = ggx_.lobe(woLocal_, wiLocal);
    if (!isOutside || lobe.value == 0) return {Rgb(0), lobe.pdf};
    const Rgb fresnel = kind_ == Kind::Conductor
                            ? conductorFresnel(lobe.cosine, index_)
                            : Rgb(fresnelReflectance(lobe.cosine, optics_->eta));
    return {fresnel * (lobe.value * wiLocal.z), lobe.pdf};
}

Bsdf::Sample Bsdf::sample(const Vec2& u) const {
    Sample result;
    if (kind_ == Kind::Black) return result;
    if (isWide()) {
        const Vec3 wiLocal = cosineDirection(u);
        if (wiLocal.z <= 0) return result;
        result.pdf = wiLocal.z / kPiF;
        result.weight = wideValue(wiLocal) * kPiF;
        result.wi = frame_.toWorld(wiLocal);
    } else {
        const ReflectionSample reflected =
            kind_ == Kind::Conductor ? sampleConductor(ggx_, woLocal_, u, index_)
                                     : sampleDielectricReflection(ggx_, woLocal_, u, optics_->eta);
        result.pdf = reflected.pdf;
        result.weight = reflected.weight;
        result.isDelta = reflected.isDelta;
        result.wi = frame_.toWorld(reflected.wi);
    }
    // Interpolated normals can send light through the surface; it is absorbed.
    if (glm::dot(result.wi, geometricNormal_) <= 0) result.pdf = 0;
    return result;
}

}  // namespace sss
