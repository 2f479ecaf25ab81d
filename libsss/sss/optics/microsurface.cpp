#include "sss/optics/microsurface.h"

#include "sss/optics/fresnel.h"
#include "sss/optics/refraction.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

// More than any walk takes: a guard.
constexpr int kMostScatterings = 4096;

Vec3 flipped(const Vec3& w) { return {w.x, w.y, -w.z}; }

// A walk from microfacet to microfacet. It is told from the side where it is, z upwards from the
// surface, which looks the same from both sides.
class Walk {
public:
    Walk(const Ggx& ggx, float eta, const Vec3& along) : ggx_(ggx), eta_(eta), along_(along) {}

    bool isBeyond() const { return isBeyond_; }
    const Vec3& along() const { return along_; }

    // Goes on to the next microfacet; false if there is none. By Smith, the share of the surface
    // that lies lower changes by v^(-cosine / visible area) over a free path, v uniform in (0, 1]:
    // [Heitz et al. 2016, section 4.1] without its heights, which do not matter.
    bool meets(float u) {
        const float area = ggx_.visibleArea(-along_);
        if (!(area > 0)) return along_.z < 0;
        logLower_ -= along_.z / area * std::log1p(-u);
        return along_.z <= 0 || logLower_ < 0;
    }

    void scatter(const Vec2& uNormal, float uFresnel) {
        const Vec3 normal = ggx_.sampleVisibleNormal(-along_, uNormal);
        const float cosine = std::clamp(-glm::dot(along_, normal), 0.0f, 1.0f);
        if (uFresnel < fresnelReflectance(cosine, eta_)) {
            along_ = glm::normalize(along_ + 2.0f * cosine * normal);
            return;
        }
        const float beyond = refractedCosine(cosine, eta_);
        along_ = flipped(glm::normalize(refractedDirection(along_, normal, cosine, beyond, eta_)));
        logLower_ = logHigher();
        eta_ = 1.0f / eta_;
        isBeyond_ = !isBeyond_;
    }

    // Density of leaving for good in a direction, told from this side, by the next scattering.
    float density(const Vec3& out) const {
        return out.z > 0 ? reflection(out) * escape(logLower_, out)
                         : refraction(out) * escape(logHigher(), flipped(out));
    }

private:
    // Of the share that lies higher, which is what is lower from beyond.
    float logHigher() const { return std::log(-std::expm1(std::min(logLower_, -1e-7f))); }

    // Upwards past everything that is higher.
    float escape(float logLower, const Vec3& up) const {
        return up.z > 0 ? std::exp(logLower * ggx_.visibleArea(-up) / up.z) : 0;
    }

    float reflection(const Vec3& out) const {
        const Vec3 sum = out - along_;
        const float length = glm::length(sum);
        if (!(length > 0)) return 0;
        const Vec3 h = sum / length;
        const float cosine = -glm::dot(along_, h);
        if (!(cosine > 0)) return 0;
        return ggx_.visibleNormalPdf(-along_, h) * fresnelReflectance(cosine, eta_) / (4 * cosine);
    }

    // [Walter et al. 2007, Eqs. 16 and 17]
    float refraction(const Vec3& out) const {
        const Vec3 sum = eta_ * out - along_;
        const float length = glm::length(sum);
        if (!(length > 0)) return 0;
        const Vec3 h = sum * ((sum.z < 0 ? -1.0f : 1.0f) / length);
        const float cosine = -glm::dot(along_, h), beyond = -glm::dot(out, h);
        if (!(cosine > 0 && beyond > 0)) return 0;
        const float root = cosine - eta_ * beyond;
        return ggx_.visibleNormalPdf(-along_, h) * (1 - fresnelReflectance(cosine, eta_)) * eta_ *
               eta_ * beyond / (root * root);
    }

    const Ggx& ggx_;
    float eta_;  // beyond / here
    Vec3 along_;
    float logLower_ = 0;  // of the share of the surface that is lower than the place: all of it
    bool isBeyond_ = false;
};

}  // namespace

Microsurface::Exit Microsurface::sample(const Vec3& wo, Sampler& sampler) const {
    Walk walk(ggx_, eta_, -wo);
    for (int n = 0; n < kMostScatterings; ++n) {
        if (!walk.meets(sampler.next1D()))
            return {walk.isBeyond() ? flipped(walk.along()) : walk.along(), n};
        const Vec2 uNormal = sampler.next2D();
        walk.scatter(uNormal, sampler.next1D());
    }
    return {{-wo.x, -wo.y, wo.z}, kMostScatterings};
}

float Microsurface::density(const Vec3& wo, const Vec3& wi, Sampler& sampler) const {
    Walk walk(ggx_, eta_, -wo);
    float sum = 0;
    for (int n = 0; n < kMostScatterings && walk.meets(sampler.next1D()); ++n) {
        sum += walk.density(walk.isBeyond() ? flipped(wi) : wi);
        const Vec2 uNormal = sampler.next2D();
        walk.scatter(uNormal, sampler.next1D());
    }
    return sum;
}

}  // namespace sss
