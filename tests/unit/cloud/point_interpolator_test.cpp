// A smooth quantity between points.
#include "sss/cloud/point_interpolator.h"

#include "cloud_tools.h"
#include "sss/base/rng.h"
#include "sss/geom/shapes.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

std::vector<SolvedExitance> valuesAt(std::span<const SurfacePoint> points,
                                     const std::function<Rgb(const Vec3&)>& f) {
    std::vector<SolvedExitance> values;
    for (const SurfacePoint& p : points)
        values.push_back({.correction = f(p.position), .thickExitance = 2.0f * f(p.position)});
    return values;
}

std::vector<Rgb> interpolated(const PointInterpolator& between, std::span<const Vec3> places) {
    std::vector<Rgb> out(places.size(), Rgb(0));
    between.addTo(places, out);
    return out;
}

TEST(PointInterpolator, ExactForWhatIsLinearOnAPlane) {
    const TriangleMesh mesh = makeRectangle(10, 6);
    const SurfaceSamples samples = sampleSurface(mesh, {.spacingMm = 0.4, .seed = 2});
    const auto linear = [](const Vec3& p) { return Rgb(1 + p.x, 2 - 3 * p.y, 0.5f); };
    const std::vector<SolvedExitance> values = valuesAt(samples.points, linear);
    const PointInterpolator between(samples.points, values, Rgb(1));
    const std::vector<Vec3> places = testing::placesOn(mesh, 300, 4);
    const std::vector<Rgb> out = interpolated(between, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
        // The rim is held within a quarter of the neighbours' range.
        if (std::abs(places[i].x) > 4.4f || std::abs(places[i].y) > 2.4f) continue;
        EXPECT_LT(glm::length(out[i] - linear(places[i])), 2e-4f);
    }
}

// Red falls along x by 1 a mm, green along y by 2: who looks from that side sees what lies `leanMm`
// behind, which is brighter.
TEST(PointInterpolator, SaysHowLightLeans) {
    const TriangleMesh mesh = makeRectangle(10, 6);
    const SurfaceSamples samples = sampleSurface(mesh, {.spacingMm = 0.4, .seed = 2});
    const std::vector<SolvedExitance> values = valuesAt(
        samples.points, [](const Vec3& p) { return 0.5f * Rgb(10 - p.x, 10 - 2 * p.y, 10); });
    const Rgb leanMm(0.5f, 0.25f, 2);
    const PointInterpolator between(samples.points, values, leanMm);
    const Vec3 place(1, -1, 0);
    Rgb correction(0);
    ExitanceSlope slope;
    between.addTo(std::span(&place, 1), std::span(&correction, 1), std::span(&slope, 1));
    EXPECT_LT(glm::length(slope.x - Rgb(0.5f, 0, 0)), 1e-4f);
    EXPECT_LT(glm::length(slope.y - Rgb(0, 0.5f, 0)), 1e-4f);
    EXPECT_LT(glm::length(slope.z), 1e-4f);
    EXPECT_LT(glm::length(slope.along({0.6f, -0.8f, 0}) - Rgb(0.3f, -0.4f, 0)), 1e-4f);
}

TEST(PointInterpolator, FollowsWhatIsSmoothOnABall) {
    const TriangleMesh mesh = makeSphere(5, 1);
    const SurfaceSamples samples = sampleSurface(mesh, {.spacingMm = 0.4, .seed = 2});
    const auto smooth = [](const Vec3& p) { return Rgb(std::exp(0.4f * p.x)); };
    const std::vector<SolvedExitance> values = valuesAt(samples.points, smooth);
    const PointInterpolator between(samples.points, values, Rgb(1));
    const std::vector<Vec3> places = testing::placesOn(mesh, 300, 4);
    const std::vector<Rgb> out = interpolated(between, places);
    for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_NEAR(out[i].x / smooth(places[i]).x, 1, 0.02);
}

TEST(PointInterpolator, SmoothsNoiseOfSinglePoints) {
    const TriangleMesh mesh = makeRectangle(10, 10);
    const SurfaceSamples samples = sampleSurface(mesh, {.spacingMm = 0.3, .seed = 2});
    Rng rng(1);
    const std::vector<SolvedExitance> values =
        valuesAt(samples.points, [&](const Vec3&) { return Rgb(rng.uniform() - 0.5f); });
    const PointInterpolator between(samples.points, values, Rgb(1));
    const std::vector<Vec3> places = testing::placesOn(mesh, 1000, 4);
    double squares = 0;
    for (const Rgb& v : interpolated(between, places)) squares += v.x * v.x;
    EXPECT_LT(std::sqrt(squares / 1000), 0.4 * std::sqrt(1.0 / 12));
}

TEST(PointInterpolator, SidesOfAThinPlateDoNotMix) {
    const TriangleMesh mesh = makeBox(DVec3(8, 8, 0.3));
    const SurfaceSamples samples = sampleSurface(mesh, {.spacingMm = 0.5, .seed = 2});
    const std::vector<SolvedExitance> values =
        valuesAt(samples.points, [](const Vec3& p) { return Rgb(p.z > 0 ? 1.0f : 0.0f); });
    const PointInterpolator between(samples.points, values, Rgb(1));
    std::vector<Vec3> places;
    for (int i = -3; i <= 3; ++i) places.emplace_back(0.9f * static_cast<float>(i), 0.2f, 0.15f);
    for (const Rgb& v : interpolated(between, places)) EXPECT_NEAR(v.x, 1, 1e-5);
}

TEST(PointInterpolator, OnePointIsThereEverywhere) {
    const SurfacePoint point{
        .position = Vec3(1), .areaMm2 = 2, .normal = encodeUnitVector({0, 0, 1})};
    const SolvedExitance value{.correction = Rgb(3, 2, 1), .thickExitance = Rgb(5)};
    const PointInterpolator between(std::span(&point, 1), std::span(&value, 1), Rgb(1));
    const Vec3 place(1.1f, 1, 1);
    EXPECT_EQ(interpolated(between, std::span(&place, 1)).front(), value.correction);
}

}  // namespace
}  // namespace sss
