#include "sss/volume/volume_segment.h"

#include "sss/geom/shapes.h"
#include "sss/optics/gauss_legendre.h"
#include "unit/volume/volume_tools.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using namespace testing;

constexpr float kFar = std::numeric_limits<float>::infinity();

struct Volumes {
    std::vector<std::unique_ptr<Volume>> volumes;
    void add(const VolumeSettings& settings, VolumePlace place) {
        volumes.push_back(std::make_unique<Volume>(settings, std::move(place)));
    }
    VolumeSegment along(const Vec3& origin, const Vec3& direction, float end = kFar) const {
        return {volumes, origin, glm::normalize(direction), end};
    }
};

TEST(VolumeSegment, SlabsDimByBeerAndLambert) {
    Volumes scene;
    VolumeSettings settings = greyVolume(0, 0);
    settings.sigmaA = {0.1f, 0.2f, 0.4f};
    settings.sigmaS = {0.3f, 0.0f, 0.1f};
    scene.add(settings, placeBetween({-100, 0, -100}, {100, 3, 100}));
    const Vec3 slant = glm::normalize(Vec3(0.4f, -1, 0.2f));
    const VolumeSegment through = scene.along({1, 5, 2}, slant);
    const VolumeSegment within = scene.along({1, 5, 2}, slant, 2.0f / -slant.y + 1.5f);
    for (int c = 0; c < 3; ++c) {
        const double sigmaT = double(settings.sigmaA[c]) + double(settings.sigmaS[c]);
        EXPECT_NEAR(through.transmittance()[c], std::exp(-3 * sigmaT / -double(slant.y)), 1e-6);
        EXPECT_NEAR(within.transmittance()[c], std::exp(-1.5 * sigmaT), 1e-6);
    }
    EXPECT_TRUE(scene.along({1, 5, 2}, {0, 1, 0}).isEmpty());
    EXPECT_EQ(scene.along({1, 5, 2}, {0, 1, 0}).transmittance(), Rgb(1));
    EXPECT_TRUE(scene.along({1, 5, 2}, slant, 1).isEmpty());
}

// Homogeneous emission: L_e (1 - e^-tau), also where the ray starts inside.
TEST(VolumeSegment, SlabAndSphereGlowByKirchhoff) {
    Volumes scene;
    VolumeSettings settings = greyVolume(0, 0.2f);
    settings.sigmaA = {0.001f, 0.5f, 4};
    settings.emission = {2, 3, 5};
    scene.add(settings, placeBetween(DVec3(-2), DVec3(2), VolumePlace::Part::Ball));
    const auto expect = [&](const VolumeSegment& segment, double length) {
        for (int c = 0; c < 3; ++c) {
            const double a = double(settings.sigmaA[c]), t = a + 0.2;
            const double radiance = a / t * double(settings.emission[c]) * -std::expm1(-t * length);
            EXPECT_NEAR(segment.emission(0)[c], radiance, 2e-6 * radiance + 1e-7);
        }
    };
    expect(scene.along({0.5f, 0, 10}, {0, 0, -1}), 2 * std::sqrt(4 - 0.25));
    expect(scene.along({0, 0, 1}, {0, 0, -1}), 3);
    expect(scene.along({0, 0, 1}, {0, 0, -1}, 0.7f), 0.7);
    scene.volumes.clear();
    scene.add(settings, placeBetween({-9, -9, 0}, {9, 9, 0.25}));
    expect(scene.along({0.5f, 0, 10}, {0, 0, -1}), 0.25);
}

// The inside of a mesh: a ring of two shells around a hole.
TEST(VolumeSegment, MeshesHaveAnInside) {
    TriangleMesh outer = makeBox({4, 4, 4});
    const TriangleMesh inner = makeBox({2, 2, 2});
    const auto first = static_cast<std::uint32_t>(outer.positions.size());
    outer.positions.insert(outer.positions.end(), inner.positions.begin(), inner.positions.end());
    for (const UVec3& f : inner.faces)
        outer.faces.emplace_back(first + f.x, first + f.z, first + f.y);
    VolumePlace place = placeBetween(DVec3(-2), DVec3(2), VolumePlace::Part::Mesh);
    place.mesh = std::move(outer);
    Volumes scene;
    scene.add(greyVolume(1, 0), std::move(place));
    const auto depth = [&](const Vec3& from, const Vec3& direction, float end = kFar) {
        return scene.along(from, direction, end).depth().x;
    };
    EXPECT_NEAR(depth({0.1f, 0.2f, 9}, {0, 0, -1}), 2, 1e-5);
    EXPECT_NEAR(depth({0.1f, 0.2f, 0}, {0, 0, -1}), 1, 1e-5);
    EXPECT_NEAR(depth({0.1f, 0.2f, 1.5f}, {0, 0, -1}), 1.5, 1e-5);
    EXPECT_NEAR(depth({0.1f, 0.2f, 1.5f}, {0, 0, -1}, 3), 1, 1e-5);
    EXPECT_NEAR(depth({1.5f, 0.2f, 9}, {0, 0, -1}), 4, 1e-5);
    EXPECT_NEAR(depth({1.5f, 0.2f, 0}, {0, 0, -1}, 0.5f), 0.5, 1e-6);
    EXPECT_EQ(depth({2.5f, 0.2f, 9}, {0, 0, -1}), 0);
}

// A grid whose nodes hold a trilinear function is that function: against quadrature of it.
class GriddedVolume : public ::testing::Test {
protected:
    static double density(const DVec3& p) { return 0.2 + p.x + 0.5 * p.y * p.z + p.x * p.y * p.z; }
    static double glow(const DVec3& p, int channel) { return channel * (1.1 - p.y) * (0.3 + p.z); }

    GriddedVolume() {
        VolumeSettings settings = greyVolume(0, 0);
        settings.sigmaA = sigmaA_;
        settings.sigmaS = sigmaS_;
        settings.emission = Rgb(3);
        settings.grid =
            writeGrid(folder_.path() / "grid.raw", {5, 4, 7}, 4, [](const DVec3& p, int c) {
                return static_cast<float>(c == 0 ? density(p) : glow(p, c));
            });
        VolumePlace place;
        place.worldFromUnit = glm::translate(DMat4(1.0), {3, -2, 1}) *
                              glm::rotate(DMat4(1.0), 0.7, glm::normalize(DVec3(1, 2, 3))) *
                              glm::scale(DMat4(1.0), {4, 2, 3});
        unitFromWorld_ = glm::inverse(place.worldFromUnit);
        scene_.add(settings, place);
    }
    DVec3 unit(const DVec3& p) const { return DVec3(unitFromWorld_ * glm::dvec4(p, 1)); }

    Rgb sigmaA_{0.2f, 0.6f, 1.5f}, sigmaS_{0.3f, 0.1f, 0};
    DMat4 unitFromWorld_{1.0};
    TemporaryFolder folder_;
    Volumes scene_;
};

TEST_F(GriddedVolume, DepthAndEmissionMatchQuadrature) {
    const DVec3 begin = DVec3(glm::inverse(unitFromWorld_) * glm::dvec4(0.03, 0.9, 0.2, 1));
    const DVec3 end = DVec3(glm::inverse(unitFromWorld_) * glm::dvec4(0.95, 0.1, 0.85, 1));
    const double length = glm::length(end - begin);
    const DVec3 direction = (end - begin) / length;
    const VolumeSegment segment =
        scene_.along(Vec3(begin), Vec3(direction), static_cast<float>(length));
    const auto columnTo = [&](double t) {
        return gauss16(0, t, [&](double s) { return density(unit(begin + direction * s)); });
    };
    for (int c = 0; c < 3; ++c) {
        const double sigmaT = double(sigmaA_[c]) + double(sigmaS_[c]);
        EXPECT_NEAR(segment.depth()[c], sigmaT * columnTo(length), 2e-5);
        EXPECT_NEAR(segment.depthTo(static_cast<float>(0.3 * length))[c],
                    sigmaT * columnTo(0.3 * length), 2e-5);
        const double emitted = gauss16(0, length, [&](double t) {
            return double(sigmaA_[c]) * 3 * glow(unit(begin + direction * t), c + 1) *
                   std::exp(-sigmaT * columnTo(t));
        });
        EXPECT_NEAR(segment.emission(0)[c], emitted, 2e-5 * emitted);
    }
    const auto t = static_cast<float>(0.6 * length);
    EXPECT_NEAR(segment.sigmaT(t).y, 0.7 * density(unit(begin + direction * double(t))), 1e-4);
}

// Collisions are found where the depth is what was drawn.
TEST_F(GriddedVolume, CollisionsInvertTheDepth) {
    const VolumeSegment segment = scene_.along({-4, -2.5f, -1}, {1, 0.15f, 0.4f});
    ASSERT_FALSE(segment.isEmpty());
    for (int c = 0; c < 3; ++c) {
        int through = 0;
        for (int k = 0; k < 200; ++k) {
            const float u = (static_cast<float>(k) + 0.5f) / 200;
            const float t = segment.sampleCollision(c, u);
            if (std::isinf(t)) {
                EXPECT_GT(-std::log1p(-u), segment.depth()[c] * (1 - 1e-5f));
                ++through;
            } else {
                EXPECT_NEAR(segment.depthTo(t)[c], -std::log1p(-u), 1e-5);
            }
        }
        EXPECT_NEAR(through / 200.0, segment.transmittance()[c], 0.006);
    }
}

// Volumes that overlap add their extinctions; what one emits the other dims.
TEST(VolumeSegment, VolumesMayOverlap) {
    Volumes scene;
    scene.add(greyVolume(0.5f, 0, 2), placeBetween({-1, -1, 0}, {1, 1, 4}));
    scene.add(greyVolume(0.25f, 0.5f), placeBetween({-1, -1, 3}, {1, 1, 6}));
    const VolumeSegment segment = scene.along({0, 0, 9}, {0, 0, -1});
    EXPECT_NEAR(segment.depth().x, 0.5 * 4 + 0.75 * 3, 1e-5);
    EXPECT_NEAR(segment.depthTo(5.5f).x, 0.75 * 2 + 1.25 * 0.5, 1e-5);
    EXPECT_NEAR(segment.sigmaT(5.5f).x, 1.25, 1e-6);
    // From z = 4 to 3 under both, behind z = 6 to 4 of the second; then alone.
    const double both = 0.5 * 2 / 1.25 * -std::expm1(-1.25), alone = 2 * -std::expm1(-0.5 * 3);
    EXPECT_NEAR(segment.emission(0).x, std::exp(-1.5) * (both + std::exp(-1.25) * alone), 1e-5);
    EXPECT_EQ(segment.emission(1), Rgb(0));
    EXPECT_TRUE(segment.scatters());
    EXPECT_FALSE(scene.along({0, 0, 2}, {0, 0, -1}).scatters());
}

}  // namespace
}  // namespace sss
