// Where a body is thin.
#include "sss/integrate/collision_probability.h"

#include "sss/integrate/preprocess.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sss {
namespace {

using testing::SceneMaker;

// Mean over diffuse light that enters a body of index eta of what leaves it again, where `length`
// mean free paths lie between one arrival at the boundary and the next, by cosine inside; there
// light arrives as it entered.
template <typename Length>
double leavesStraight(double eta, const Length& length) {
    double leaves = 0, entered = 0;
    constexpr int kSteps = 2000;
    for (int k = 0; k < kSteps; ++k) {
        const double cosine = (k + 0.5) / kSteps, reflected = fresnelReflectance(cosine, eta);
        const double passed = std::exp(-length(refractedCosine(cosine, eta)));
        entered += cosine * (1 - reflected);
        leaves += cosine * (1 - reflected) * passed * (1 - reflected) / (1 - reflected * passed);
    }
    return leaves / entered;
}

struct Looked {
    DiffusionConstants medium;
    std::vector<SurfacePoint> points;
    std::vector<Rgb> collided;
    CollisionCounts counts;
};

Looked lookInto(const Shape& shape, const TranslucentMaterial& material, double spacingMm) {
    SceneMaker maker;
    maker.object(shape, maker.material(material),
                 testing::moved({1, 2, -3}) * testing::turned(25, {1, 2, 0}));
    maker.scene.quality.spacingMm = spacingMm;
    const World world = maker.world();
    const auto optics = makeBodyOptics(world);
    SilentReporter silent;
    BodyReport report;
    Looked looked;
    looked.medium = diffusionConstants(material.medium, exactFresnelMoments(material.medium.eta));
    looked.points = placePoints(world, 0, *optics[0], {}, silent, report).points;
    looked.collided = collisionProbabilities(world, 0, looked.points, looked.medium, looked.counts);
    return looked;
}

TranslucentMaterial coloured(double eta) {
    TranslucentMaterial material = testing::grey(0.01, 0.99, eta);
    material.medium.sigmaA = {0.01, 0.02, 0.005};
    material.medium.sigmaS = {0.99, 1.98, 0.495};
    return material;
}

struct Errors {
    double mean = 0, rms = 0;
};
Errors errorsOf(std::span<const Rgb> found, int c, double expected) {
    Errors errors;
    for (const Rgb& value : found) {
        errors.mean += double{value[c]} - expected;
        errors.rms += std::pow(double{value[c]} - expected, 2);
    }
    errors.mean /= static_cast<double>(found.size());
    errors.rms = std::sqrt(errors.rms / static_cast<double>(found.size()));
    return errors;
}

TEST(CollisionProbability, OfBallsIsTheClosedForm) {
    for (const auto& [eta, radius] : {std::pair{1.3, 0.25}, {1.0, 1.0}, {1.3, 2.0}}) {
        const Looked ball = lookInto(SphereShape{radius}, coloured(eta), radius / 5);
        ASSERT_GT(ball.points.size(), 200u);
        for (int c = 0; c < 3; ++c) {
            const double diameter = ball.medium.fading[c] * 2 * radius;
            const Errors errors =
                errorsOf(ball.collided, c,
                         1 - leavesStraight(eta, [&](double cosine) { return diameter * cosine; }));
            EXPECT_NEAR(errors.mean, 0, 2e-3) << eta << " " << radius << " " << c;
            EXPECT_LT(errors.rms, 1e-2) << eta << " " << radius << " " << c;
        }
    }
}

TEST(CollisionProbability, OfPlatesIsTheClosedForm) {
    const double thickness = 1.2, eta = 1.4;
    const Looked plate = lookInto(BoxShape{{40, 40, thickness}}, coloured(eta), 1.5);
    std::vector<Rgb> within;  // far from the rim
    for (std::size_t i = 0; i < plate.points.size(); ++i)
        if (glm::length(plate.points[i].position - Vec3(0)) < 10)
            within.push_back(plate.collided[i]);
    ASSERT_GT(within.size(), 100u);
    for (int c = 0; c < 3; ++c) {
        const double depth = plate.medium.fading[c] * thickness;
        const Errors errors = errorsOf(
            within, c, 1 - leavesStraight(eta, [&](double cosine) { return depth / cosine; }));
        EXPECT_NEAR(errors.mean, 0, 2e-3) << c;
        EXPECT_LT(errors.rms, 1e-2) << c;
    }
}

// Nothing comes through: known for certain, from few rays.
TEST(CollisionProbability, IsOneWhereTheBodyIsThick) {
    const Looked ball = lookInto(SphereShape{200}, coloured(1.3), 20);
    std::size_t thin = 0;  // by lines of sight along the surface
    for (const Rgb& value : ball.collided) thin += minComponent(value) < 0.999f;
    EXPECT_EQ(thin, 0u);
    EXPECT_LE(ball.counts.rays, 4 * ball.points.size());
}

// A channel in which nothing scatters is none to solve; a film has next to none that does.
TEST(CollisionProbability, IsBounded) {
    TranslucentMaterial clear = coloured(1.3);
    clear.medium.sigmaS.y = clear.medium.sigmaA.y = 0;
    const Looked film = lookInto(BoxShape{{20, 20, 1e-3}}, clear, 2);
    for (const Rgb& value : film.collided) {
        EXPECT_EQ(value.y, 1);
        EXPECT_GE(minComponent(value), kLeastCollided);
        EXPECT_LE(maxComponent(value), 1);
    }
}

}  // namespace
}  // namespace sss
