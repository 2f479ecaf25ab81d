#include "sss/light/mesh_light.h"

#include "sss/light/geometry.h"

#include <algorithm>

namespace sss {
namespace {

DVec3 doubleAreaVector(const MeshLight::Triangle& t) {
    return glm::cross(DVec3(t[1]) - DVec3(t[0]), DVec3(t[2]) - DVec3(t[0]));
}

std::vector<double> areas(const std::vector<MeshLight::Triangle>& triangles) {
    std::vector<double> result;
    result.reserve(triangles.size());
    for (const MeshLight::Triangle& triangle : triangles)
        result.push_back(0.5 * glm::length(doubleAreaVector(triangle)));
    return result;
}

}  // namespace

MeshLight::MeshLight(std::vector<Triangle> triangles, const Emission& emission)
    : triangles_(std::move(triangles)), emission_(emission), choice_(areas(triangles_)) {
    for (const Triangle& triangle : triangles_)
        for (const Vec3& corner : triangle) bounds_.add(corner);
}

LightSample MeshLight::sample(const Vec3& from, const Vec2& u) const {
    const PiecewiseConstant1D::Sample chosen = choice_.sample(u.x);
    const Triangle& triangle = triangles_[chosen.cell];
    const float root = std::sqrt(chosen.within);
    const Vec3 point = triangle[0] * (1.0f - root) + triangle[1] * (root * (1.0f - u.y)) +
                       triangle[2] * (root * u.y);

    const DVec3 areaVector = doubleAreaVector(triangle);
    const double length = glm::length(areaVector);
    const Vec3 offset = point - from;
    const float distance = glm::length(offset);
    if (!(length > 0) || !(distance > 0)) return {};
    const Vec3 normal(areaVector / length);
    LightSample sample{offset / distance, distance, Rgb{0.0f}, pdfForHit(from, point, normal)};
    sample.radiance = radianceTowards(sample.direction, normal);
    return sample;
}

Rgb MeshLight::radianceTowards(const Vec3& direction, const Vec3& faceNormal) const {
    const bool shines = emission_.twoSided || glm::dot(direction, faceNormal) < 0;
    return shines ? emission_.radiance : Rgb{0.0f};
}

float MeshLight::pdfForHit(const Vec3& from, const Vec3& hitPoint, const Vec3& faceNormal) const {
    const DVec3 offset = DVec3(hitPoint) - DVec3(from);
    const double distance2 = glm::dot(offset, offset);
    const double towards = -glm::dot(offset, DVec3(faceNormal));
    const double height = emission_.twoSided ? std::abs(towards) : towards;
    if (!(height > 0)) return 0;
    return static_cast<float>(distance2 * std::sqrt(distance2) / (height * areaMm2()));
}

bool MeshLight::isBelow(const Vec3& point, const Vec3& normal) const {
    // The corner of its box that lies highest.
    const Vec3 half = 0.5f * bounds_.size();
    return glm::dot(bounds_.centre() - point, normal) + glm::dot(half, glm::abs(normal)) <= 0;
}

float MeshLight::importance(const Bounds& target) const {
    // Every face may look anywhere: a quarter of the area is what a closed shape shows on average,
    // all of it what an open one shows at most.
    const double distance2 = importanceDistanceSquared(DVec3(bounds_.centre()), target);
    return meanComponent(emission_.radiance) *
           static_cast<float>(std::min(kPi, areaMm2() / distance2));
}

}  // namespace sss
