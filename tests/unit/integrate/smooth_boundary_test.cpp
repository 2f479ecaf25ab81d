#include "sss/integrate/smooth_boundary.h"

#include "sss/optics/fresnel.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

Vec3 towards(float degrees, float z) {
    const float angle = glm::radians(degrees);
    return {std::sin(angle), 0, z * std::cos(angle)};
}

SurfaceHit faceUp(const Vec3& shading = {0, 0, 1}) {
    SurfaceHit hit;
    hit.geometricNormal = {0, 0, 1};
    hit.shadingNormal = glm::normalize(shading);
    return hit;
}

// Just above and below Fresnel's reflectance the path goes the one way and the other, by Snell's
// law; beyond the critical angle there is one way only.
TEST(SmoothBoundary, SnellAndFresnelFromBothSides) {
    for (const float eta : {0.8f, 1.33f, 2.0f})
        for (const float degrees : {0.0f, 20.0f, 50.0f, 80.0f})
            for (const bool fromInside : {false, true}) {
                SCOPED_TRACE(::testing::Message() << eta << ' ' << degrees << ' ' << fromInside);
                const Vec3 along = towards(degrees, fromInside ? 1.0f : -1.0f);
                const float cosine = std::abs(along.z);
                const float share = fromInside ? fresnelReflectanceFromInside(cosine, eta)
                                               : fresnelReflectance(cosine, eta);
                const BoundaryEvent mirrored =
                    sampleBoundary(faceUp(), along, eta, share * 0.9999f);
                ASSERT_TRUE(mirrored.isReflected);
                EXPECT_EQ(mirrored.isInside, fromInside);
                EXPECT_NEAR(mirrored.direction.z, -along.z, 1e-6);
                EXPECT_NEAR(mirrored.direction.x, along.x, 1e-6);
                EXPECT_GT(glm::dot(mirrored.side, mirrored.direction), 0);
                if (share == 1.0f) continue;
                const BoundaryEvent bent =
                    sampleBoundary(faceUp(), along, eta, share * 1.0001f + 1e-6f);
                ASSERT_FALSE(bent.isReflected);
                EXPECT_EQ(bent.isInside, !fromInside);
                EXPECT_GT(bent.direction.z * along.z, 0);
                EXPECT_NEAR(bent.direction.x, fromInside ? along.x * eta : along.x / eta, 1e-5);
                EXPECT_GT(glm::dot(bent.side, bent.direction), 0);
            }
}

// A normal that would send light through the face gives way to the face's own.
TEST(SmoothBoundary, BentNormalsKeepTheSides) {
    for (const Vec3& shading : {Vec3(0.9f, 0, 0.3f), Vec3(-0.9f, 0, 0.3f), Vec3(0, 0.9f, 0.2f)})
        for (const float z : {-1.0f, 1.0f})
            for (const float degrees : {5.0f, 45.0f, 85.0f})
                for (const float u : {0.0f, 0.5f, 0.999f}) {
                    const BoundaryEvent event =
                        sampleBoundary(faceUp(shading), towards(degrees, z), 1.5f, u);
                    EXPECT_GT(glm::dot(event.direction, event.side), 0);
                    EXPECT_EQ(event.side.z < 0, event.isInside);
                    EXPECT_NEAR(glm::length(event.direction), 1, 1e-6);
                }
}

}  // namespace
}  // namespace sss
