#include "sss/light/rectangle_light.h"

#include "sss/light/geometry.h"
#include "sss/light/rectangle_simd.h"

namespace sss {
namespace {

// Below this (sr) uniform area sampling is as good, and keeps its digits.
constexpr double kSmallSolidAngle = 1e-5;

/// Unit vector across `up` and `normal`; any, if they are parallel.
DVec3 acrossOf(const DVec3& up, const DVec3& normal) {
    const DVec3 across = glm::cross(up, normal);
    const double length = glm::length(across);
    return length > 1e-9 * glm::length(up) ? across / length : DVec3(Frame(Vec3(normal)).tangent);
}

}  // namespace

RectangleLightSource::RectangleLightSource(const RectangleLight& settings, const DVec3& originMm)
    : centre_(settings.centre - originMm),
      normal_(glm::normalize(settings.lookAt - settings.centre)),
      halfWidth_(0.5 * settings.widthMm),
      halfHeight_(0.5 * settings.heightMm),
      radiance_(settings.radiance),
      twoSided_(settings.twoSided) {
    reach2_ = static_cast<float>(halfWidth_ * halfWidth_ + halfHeight_ * halfHeight_);
    across_ = acrossOf(settings.up, normal_);
    up_ = glm::normalize(glm::cross(normal_, across_));
    across_ = glm::cross(up_, normal_);
}

DVec3 RectangleLightSource::centreFrom(const Vec3& from) const {
    const DVec3 offset = centre_ - DVec3(from);
    return {glm::dot(offset, across_), glm::dot(offset, up_), glm::dot(offset, normal_)};
}

RectangleView RectangleLightSource::viewOf(const DVec3& centreLocal) const {
    return {centreLocal.x - halfWidth_, centreLocal.x + halfWidth_, centreLocal.y - halfHeight_,
            centreLocal.y + halfHeight_, std::abs(centreLocal.z)};
}

double RectangleLightSource::pdf(const RectangleView& view, double solidAngle,
                                 const DVec2& point) const {
    if (solidAngle >= kSmallSolidAngle) return 1 / solidAngle;
    const double distance2 = glm::dot(point, point) + view.height * view.height;
    return distance2 * std::sqrt(distance2) / (view.height * 4 * halfWidth_ * halfHeight_);
}

LightSample RectangleLightSource::sample(const Vec3& from, const Vec2& u) const {
    const DVec3 centre = centreFrom(from);
    if (!shinesOn(centre)) return {};
    const RectangleView view = viewOf(centre);
    const SphericalRectangle rectangle(view);
    const DVec2 point = rectangle.solidAngle() >= kSmallSolidAngle
                            ? rectangle.sample(DVec2(u))
                            : DVec2{view.x0 + 2 * halfWidth_ * static_cast<double>(u.x),
                                    view.y0 + 2 * halfHeight_ * static_cast<double>(u.y)};
    const DVec3 offset = across_ * point.x + up_ * point.y + normal_ * centre.z;
    const double distance = glm::length(offset);
    return {Vec3(offset / distance), static_cast<float>(distance), radiance_,
            static_cast<float>(pdf(view, rectangle.solidAngle(), point))};
}

void RectangleLightSource::sampleTogether(std::span<const Vec3> from, std::span<const Vec2> u,
                                          std::span<LightSample> samples) const {
    sampleRectangle({Vec3(centre_), Vec3(across_), Vec3(up_), Vec3(normal_),
                     static_cast<float>(halfWidth_), static_cast<float>(halfHeight_)},
                    from, u, samples);
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (samples[i].pdf > 0)
            samples[i].radiance = radiance_;
        else
            samples[i] = sample(from[i], u[i]);
    }
}

Light::Seen RectangleLightSource::seen(const Vec3& from, const Vec3& direction) const {
    // Most rays pass well beside it; float is enough to say so, with room for its rounding.
    const Vec3 toCentre = Vec3(centre_) - from;
    const float along = glm::dot(toCentre, direction), far2 = glm::dot(toCentre, toCentre);
    if (far2 - along * along > reach2_ + 1e-4f * far2) return {};
    const DVec3 centre = centreFrom(from);
    const DVec3 d(direction);
    const double distance = centre.z / glm::dot(d, normal_);
    if (!shinesOn(centre) || !(distance > 0) || std::isinf(distance)) return {};
    const DVec2 point{glm::dot(d, across_) * distance, glm::dot(d, up_) * distance};
    if (std::abs(point.x - centre.x) > halfWidth_ || std::abs(point.y - centre.y) > halfHeight_)
        return {};
    const RectangleView view = viewOf(centre);
    const double solidAngle = SphericalRectangle(view).solidAngle();
    return {radiance_, static_cast<float>(pdf(view, solidAngle, point)),
            static_cast<float>(distance)};
}

Bounds RectangleLightSource::visibleBounds() const {
    const DVec3 half = halfWidth_ * glm::abs(across_) + halfHeight_ * glm::abs(up_);
    Bounds box;
    box.add(Vec3(centre_ - half));
    box.add(Vec3(centre_ + half));
    return box;
}

bool RectangleLightSource::isBelow(const Vec3& point, const Vec3& normal) const {
    // The corner that lies highest.
    const DVec3 n(normal);
    return glm::dot(centre_ - DVec3(point), n) + halfWidth_ * std::abs(glm::dot(across_, n)) +
               halfHeight_ * std::abs(glm::dot(up_, n)) <=
           0;
}

float RectangleLightSource::importance(const Bounds& target) const {
    const double front = largestCosine(centre_, normal_, target);
    const double back = twoSided_ ? largestCosine(centre_, -normal_, target) : 0;
    const double cosine = std::max({front, back, 0.0});
    const double solidAngle =
        cosine * 4 * halfWidth_ * halfHeight_ / importanceDistanceSquared(centre_, target);
    return meanComponent(radiance_) * static_cast<float>(std::min(kPi, solidAngle));
}

}  // namespace sss
