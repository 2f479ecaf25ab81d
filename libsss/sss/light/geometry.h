#pragma once
#include "sss/base/bounds.h"

#include <algorithm>

namespace sss {

/// Squared distance (mm^2) from which a light at `position` is taken to light `target`: to its
/// centre, but no nearer than its bounding sphere reaches, so that it stays finite inside.
inline double importanceDistanceSquared(const DVec3& position, const Bounds& target) {
    const DVec3 offset = DVec3(target.centre()) - position;
    const double radius = 0.5 * static_cast<double>(target.diagonal());
    return std::max({glm::dot(offset, offset), radius * radius, 1e-12});
}

/// Largest cosine between `axis` (unit) and a direction from `position` to a point of the sphere
/// around `target`.
inline double largestCosine(const DVec3& position, const DVec3& axis, const Bounds& target) {
    const DVec3 offset = DVec3(target.centre()) - position;
    const double distance = glm::length(offset);
    const double radius = 0.5 * static_cast<double>(target.diagonal());
    if (distance <= radius) return 1;
    const double cosine = std::clamp(glm::dot(offset, axis) / distance, -1.0, 1.0);
    const double sinHalf = radius / distance;  // half angle of the sphere
    const double cosHalf = std::sqrt(1 - sinHalf * sinHalf);
    if (cosine >= cosHalf) return 1;
    return cosine * cosHalf + std::sqrt(1 - cosine * cosine) * sinHalf;
}

}  // namespace sss
