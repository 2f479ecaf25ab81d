#include "sss/optics/microfacet.h"

#include "sss/optics/fresnel.h"

#include <algorithm>

namespace sss {
namespace {

bool areAbove(const Vec3& wo, const Vec3& wi) { return wo.z > 0 && wi.z > 0; }

/// Without its Fresnel factor; `h` receives the microfacet normal.
ReflectionSample sampleLobe(const Ggx& ggx, const Vec3& wo, const Vec2& u, Vec3& h) {
    ReflectionSample sample;
    h = {0, 0, 1};
    if (!(wo.z > 0)) return sample;
    if (ggx.isSpecular()) return {{-wo.x, -wo.y, wo.z}, Rgb{1.0f}, 1.0f, true};
    h = ggx.sampleVisibleNormal(wo, u);
    sample.wi = glm::normalize(mirrored(wo, h));
    if (!(sample.wi.z > 0)) return sample;
    const Ggx::Lobe lobe = ggx.lobe(wo, sample.wi);
    sample.pdf = lobe.pdf;
    sample.weight = Rgb{lobe.share};
    return sample;
}

}  // namespace

float Ggx::lambda(const Vec3& w) const {
    const float cos2 = w.z * w.z;
    if (cos2 <= 0) return 0;
    const float tan2 = (w.x * w.x + w.y * w.y) / cos2;
    // (sqrt(1 + a) - 1) / 2 without its cancellation.
    const float a = alpha_ * alpha_ * tan2;
    return 0.5f * a / (1.0f + std::sqrt(1.0f + a));
}

float Ggx::normalDensity(const Vec3& h) const {
    if (isSpecular() || !(h.z > 0)) return 0;
    const float alpha2 = alpha_ * alpha_;
    const float e = (h.x * h.x + h.y * h.y) / alpha2 + h.z * h.z;
    return 1.0f / (kPiF * alpha2 * e * e);
}

float Ggx::visibleArea(const Vec3& w) const {
    const float slopes = alpha_ * alpha_ * (w.x * w.x + w.y * w.y);
    const float root = std::sqrt(w.z * w.z + slopes);
    // (root + z) / 2 without its cancellation.
    if (w.z >= 0) return 0.5f * (root + w.z);
    return 0.5f * slopes / (root - w.z);
}

Vec3 Ggx::sampleVisibleNormal(const Vec3& wo, const Vec2& u) const {
    // Stretch so that the distribution is a hemisphere, seen from `view`.
    const Vec3 view = glm::normalize(Vec3{alpha_ * wo.x, alpha_ * wo.y, wo.z});
    const float length2 = view.x * view.x + view.y * view.y;
    const Vec3 t1 = length2 > 0 ? Vec3{-view.y, view.x, 0} / std::sqrt(length2) : Vec3{1, 0, 0};
    const Vec3 t2 = glm::cross(view, t1);

    // A uniform point on the hemisphere's projection: half a disk and half a squeezed one.
    const float radius = std::sqrt(u.x), angle = 2.0f * kPiF * u.y;
    const float p1 = radius * std::cos(angle);
    const float s = 0.5f * (1.0f + view.z);
    const float p2 =
        (1.0f - s) * std::sqrt(std::max(0.0f, 1.0f - p1 * p1)) + s * radius * std::sin(angle);

    const Vec3 onHemisphere =
        p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0f, 1.0f - p1 * p1 - p2 * p2)) * view;
    return glm::normalize(
        Vec3{alpha_ * onHemisphere.x, alpha_ * onHemisphere.y, std::max(0.0f, onHemisphere.z)});
}

float Ggx::visibleNormalPdf(const Vec3& wo, const Vec3& h) const {
    const float area = visibleArea(wo);
    return area > 0 ? std::max(0.0f, glm::dot(wo, h)) * normalDensity(h) / area : 0;
}

Ggx::Lobe Ggx::lobe(const Vec3& wo, const Vec3& wi) const {
    if (isSpecular() || !areAbove(wo, wi)) return {};
    const Vec3 h = glm::normalize(wo + wi);
    const float density = normalDensity(h), out = 1.0f + lambda(wo), both = out + lambda(wi);
    // The Jacobian 1 / (4 wo.h) cancels the cosine of the visible normals' density.
    return {density / (4.0f * wo.z * wi.z * both), 0.25f * density / (out * wo.z), out / both,
            glm::dot(wi, h)};
}

Rgb conductorFresnel(float cosine, const ConductorIndex& index) {
    return {conductorReflectance(cosine, index.eta.x, index.k.x),
            conductorReflectance(cosine, index.eta.y, index.k.y),
            conductorReflectance(cosine, index.eta.z, index.k.z)};
}

ReflectionSample sampleConductor(const Ggx& ggx, const Vec3& wo, const Vec2& u,
                                 const ConductorIndex& index) {
    Vec3 h;
    ReflectionSample sample = sampleLobe(ggx, wo, u, h);
    if (sample.pdf > 0) sample.weight *= conductorFresnel(glm::dot(wo, h), index);
    return sample;
}

ReflectionSample sampleDielectricReflection(const Ggx& ggx, const Vec3& wo, const Vec2& u,
                                            float eta) {
    Vec3 h;
    ReflectionSample sample = sampleLobe(ggx, wo, u, h);
    if (sample.pdf > 0) sample.weight *= fresnelReflectance(glm::dot(wo, h), eta);
    return sample;
}

}  // namespace sss
