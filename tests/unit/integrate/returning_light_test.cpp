// What a body sends to itself.
#include "sss/integrate/returning_light.h"

#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "sss/optics/gauss_legendre.h"
#include "unit/integrate/pass_maker.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::grey;
using testing::SceneMaker;

constexpr double kPairEta = 1.4;

// A ball of 6 mm with a hollow of 4 mm, seen from within the hollow only by itself.
struct HollowBall {
    SceneMaker maker;
    std::unique_ptr<World> world;
    std::vector<std::unique_ptr<BodyOptics>> optics;
    BodyCloud cloud;

    explicit HollowBall(int bounces) {
        const int material = maker.material(grey(0.1, 2, kPairEta));
        maker.object(SphereShape{6}, material).group = "hollow";
        maker.object(SphereShape{4}, material).group = "hollow";
        maker.light(EnvironmentLight{Rgb(1), {}, 0});
        maker.scene.quality.spacingMm = 0.8;
        maker.scene.quality.bounces = bounces;
        SilentReporter silent;
        world = std::make_unique<World>(maker.scene, silent);
        optics = makeBodyOptics(*world);
        BodyReport report;
        const SurfaceSamples samples = placePoints(*world, 0, *optics[0], {}, silent, report);
        cloud = buildCloud(samples, std::vector<Rgb>(samples.size(), Rgb(0)), report);
    }
    bool isInner(std::size_t point) const { return glm::length(cloud.points[point].position) < 5; }
    DRgb meanInside(std::span<const Rgb> values) const {
        DRgb sum{0};
        double area = 0;
        for (std::size_t p = 0; p < values.size(); ++p) {
            if (!isInner(p)) continue;
            sum += double{cloud.points[p].areaMm2} * DRgb(values[p]);
            area += cloud.points[p].areaMm2;
        }
        return sum / area;
    }
};

// Inside a sphere every chord meets the wall at the same angle twice: of exitance 1 the share
// 2 / T integral of F_t^2 c dc enters again.
double shareThatReturns() {
    double share = 0;
    for (const GaussPoint& point : kGauss16) {
        const double entering = 1 - fresnelReflectance(point.node, kPairEta);
        share += 2 * point.weight * point.node * entering * entering;
    }
    return share / hemisphericalTransmittance(kPairEta);
}

// Of what returns, the diffuse limit sends out again.
TEST(ReturningLight, FillsAHollowSphere) {
    const double share = shareThatReturns();
    for (const int bounces : {1, 3}) {
        const HollowBall ball(bounces);
        const BodyCloud::View view = ball.cloud.view();
        const ReturningLight back(*ball.world, 0, *ball.optics[0], view);
        ASSERT_FALSE(back.isNone());
        const std::vector<Rgb> found =
            back.irradiance(std::vector<Rgb>(ball.cloud.points.size(), Rgb(1, 2, 0)));
        double expected = 0, sent = 1;
        for (int k = 0; k < bounces; ++k) {
            expected += share * sent;
            sent *= share * double{ball.optics[0]->diffuseAlbedo.x};
        }
        for (std::size_t p = 0; p < found.size(); ++p) {
            if (!ball.isInner(p)) {
                ASSERT_EQ(found[p], Rgb(0)) << p;
            }
        }
        const DRgb mean = ball.meanInside(found);
        EXPECT_NEAR(mean.x / expected, 1, 0.005) << bounces;
        EXPECT_NEAR(mean.y / expected, 2, 0.01) << bounces;
        EXPECT_EQ(mean.z, 0);
    }
}

// What pass 1 has reckoned with is not added again; light that it has overrated is taken back.
TEST(ReturningLight, ReplacesTheDiffuseLimits) {
    HollowBall ball(1);
    ball.cloud.irradiance.assign(ball.cloud.points.size(), Rgb(2));
    const BodyCloud::View view = ball.cloud.view();
    const ReturningLight back(*ball.world, 0, *ball.optics[0], view);
    const Rgb limit = 2.0f * ball.optics[0]->diffuseAlbedo;
    for (const Rgb& same : back.irradiance(std::vector<Rgb>(ball.cloud.points.size(), limit)))
        EXPECT_LT(glm::length(same - Rgb(2)), 1e-5f);
    const std::vector<Rgb> less =
        back.irradiance(std::vector<Rgb>(ball.cloud.points.size(), 0.5f * limit));
    EXPECT_NEAR(ball.meanInside(less).x, 2 - 0.5 * double{limit.x} * shareThatReturns(), 0.005);
}

// In the dark all beams go where light of the body itself does: down from the wall, bent towards
// the normal.
TEST(ReturningLight, BeamsFollowItInTheDark) {
    const HollowBall ball(1);
    const BodyCloud::View view = ball.cloud.view();
    const ReturningLight back(*ball.world, 0, *ball.optics[0], view);
    EnteredBeams before;
    before.directions.assign(ball.cloud.points.size() * EnteredBeams::kPerPoint,
                             encodeUnitVector({0, 0, 1}));
    const std::vector<Rgb> irradiance =
        back.irradiance(std::vector<Rgb>(ball.cloud.points.size(), Rgb(1)));
    const EnteredBeams after = back.beams(before, irradiance);
    const double steepest =
        std::sqrt(1 - 1 / (kPairEta * kPairEta));  // cosine of the critical angle
    for (std::size_t p = 0; p < ball.cloud.points.size(); ++p) {
        const Vec3 normal = decodeUnitVector(ball.cloud.points[p].normal);
        for (std::size_t k = 0; k < EnteredBeams::kPerPoint; ++k) {
            const std::uint32_t beam = after.of(p)[k];
            if (ball.isInner(p))
                EXPECT_GT(-glm::dot(normal, decodeUnitVector(beam)), steepest - 0.1) << p;
            else
                EXPECT_EQ(beam, before.of(p)[k]) << p;
        }
    }
}

TEST(ReturningLight, IsNoneOfAConvexBodyOrWithoutBounces) {
    const HollowBall still(0);
    const BodyCloud::View view = still.cloud.view();
    EXPECT_TRUE(ReturningLight(*still.world, 0, *still.optics[0], view).isNone());
    SceneMaker maker;
    maker.object(SphereShape{3}, maker.material(grey(0.1, 2, kPairEta)));
    maker.scene.quality.bounces = 4;
    maker.scene.quality.spacingMm = 1;
    const World world = maker.world();
    const auto optics = makeBodyOptics(world);
    const testing::MadeClouds made(world, optics);
    const BodyCloud::View convex = made.clouds[0].view();
    EXPECT_TRUE(ReturningLight(world, 0, *optics[0], convex).isNone());
}

}  // namespace
}  // namespace sss
