// What holds for every body: energy, tolerance, bounds.
#include "sss/shape/shape_solver.h"

#include "sss/geom/shapes.h"
#include "sss/shape/screened_green.h"
#include "unit/shape/solved_body.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::constantsOf;
using testing::everywhere;
using testing::fromAbove;
using testing::Solved;

// What enters leaves, scattered or straight, or is absorbed: where it would have scattered first,
// or later, by the fluence inside, from the boundary's.
TEST(ShapeSolver, ConservesEnergy) {
    Medium absorbing;
    absorbing.sigmaS = {2, 1, 1};
    absorbing.sigmaA = {0.05, 0.1, 0.2};
    absorbing.eta = 1.3;
    const DiffusionConstants medium = diffusionConstants(absorbing, exactFresnelMoments(1.3));
    const double l = 1 / medium.extinction.y, radius = 1.5 * l;
    const Solved ball(makeSphere(radius, 6), 0.15 * l, 2 * radius, medium, everywhere);
    const double cell = ball.cloud.spacingMm / std::sqrt(kPi);
    const ScreenedGreen r(medium.screening.x, 3 * radius), g(medium.screening.y, 3 * radius),
        b(medium.screening.z, 3 * radius);
    const KernelTable green({&r, &g, &b}, 3 * radius, 0.5 * cell);
    ChargeTree tree(ball.cloud.view(), ball.cloud.nodes);
    tree.setFluence(ball.fluence, std::vector<DRgb>(ball.fluence.size(), 1.0 / medium.boundaryMm));
    const LayerSum layers(tree, green, 1.0 / medium.boundaryMm);
    const SourceCloud sources(ball.sources);
    const DiffusionSum direct(sources.view(), sources.nodes(), green);
    // Shells; the fluence depends on the radius alone, but for the sources' graininess.
    constexpr int kShells = 80, kDirections = 30;
    DRgb absorbed{0};
    const std::vector<Vec3> directions = testing::placesOn(makeSphere(1), kDirections, 5);
    for (int k = 0; k < kShells; ++k) {
        const double at = radius * (k + 0.5) / kShells;
        DRgb mean{0};
        for (const Vec3& d : directions) {
            const Vec3 place = glm::normalize(d) * static_cast<float>(at);
            mean += (direct.bruteForce(place) / medium.diffusionMm - layers.bruteForce(place)) /
                    static_cast<double>(kDirections);
        }
        const double volume = 4 * kPi * at * at * radius / kShells;
        absorbed += medium.screening * medium.screening * medium.diffusionMm * mean * volume;
    }
    const DRgb straight = ball.entered * glm::exp(-2 * radius * medium.extinction);
    const DRgb absorbedFirst = (1.0 - medium.reducedAlbedo) * (ball.entered - straight);
    const DRgb leaves = ball.mean(everywhere) * static_cast<double>(makeSphere(radius, 6).area());
    for (int c = 0; c < 3; ++c) {
        const double known = leaves[c] + absorbed[c] + absorbedFirst[c] + straight[c];
        EXPECT_NEAR(known / ball.entered[c], 1, 5e-3) << "channel " << c;
        EXPECT_GT(straight[c] / ball.entered[c], 2e-3);
        EXPECT_GT(absorbed[c] / ball.entered[c], 0.03);
    }
}

// Loose and tight tolerances differ by less than the loose one.
TEST(ShapeSolver, KeepsItsTolerance) {
    for (const char* name : {"marble", "ketchup"}) {
        const DiffusionConstants medium = constantsOf(name);
        const double l = 1 / medium.extinction.z, radius = 8 * l;
        const auto isLit = [](const SurfacePoint& p) { return decodeUnitVector(p.normal).x > 0; };
        const Solved fine(makeSphere(radius, 6), 0.8 * l, 2 * radius, medium, isLit);
        std::vector<DRgb> loose = fine.fluence;
        // A guess that is right to a factor of a few, as the profile's is.
        for (DRgb& v : loose) v = glm::max(v * DRgb(0.7, 1.4, 1.0), DRgb(1e-5));
        const ShapeSolver solver(fine.cloud.view(), fine.cloud.nodes, medium, fine.cloud.spacingMm,
                                 2.02 * radius, 0.02);
        solver.solve(fine.sources, loose);
        double squares = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < loose.size(); ++i) {
            if (fine.cloud.samples.points[i].position.x < -radius / 2) continue;  // 1e-6 and less
            squares += std::pow(loose[i].y / fine.fluence[i].y - 1, 2);
            ++count;
        }
        EXPECT_LT(std::sqrt(squares / static_cast<double>(count)), 0.02) << name;
    }
}

// Less leaves where the body is thin: as by a longer extrapolation length.
TEST(ShapeSolver, LessLeavesByALongerLength) {
    const DiffusionConstants medium = constantsOf("skimmilk");
    const double l = 1 / medium.extinction.z, radius = 3 * l;
    DiffusionConstants longer = medium;
    longer.boundaryMm /= DRgb(0.5, 0.7, 0.9);
    const Solved expected(makeSphere(radius, 5), 0.8 * l, 2 * radius, longer, fromAbove);
    const std::vector<Rgb> collided(expected.fluence.size(), Rgb(0.5f, 0.7f, 0.9f));
    const ShapeSolver solver(expected.cloud.view(), expected.cloud.nodes, medium,
                             expected.cloud.spacingMm, 2.02 * radius, 1e-3, collided);
    std::vector<DRgb> fluence = expected.fluence;
    for (DRgb& v : fluence) v *= 1.3;
    solver.solve(expected.sources, fluence);
    for (std::size_t i = 0; i < fluence.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(fluence[i][c] / expected.fluence[i][c], 1, 0.01) << i << " " << c;
}

// Two sheets closer together than the points: a few times what scatters there, which is little.
TEST(ShapeSolver, ThinPartsStayBounded) {
    const DiffusionConstants medium = constantsOf("marble");
    const double l = 1 / medium.extinction.z;
    for (const double thickness : {0.3 * l, 0.03 * l, 1e-4 * l}) {
        const Solved leaf(makeBox(DVec3(12 * l, 12 * l, thickness)), 1.0 * l, thickness, medium,
                          fromAbove);
        const DRgb scattered =
            medium.reducedAlbedo * (1.0 - glm::exp(-medium.extinction * thickness));
        for (std::size_t i = 0; i < leaf.fluence.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                EXPECT_TRUE(std::isfinite(leaf.fluence[i][c]));
                EXPECT_GE(leaf.exitance(i)[c], 0);
                EXPECT_LT(leaf.exitance(i)[c], 4 * scattered[c]);
            }
    }
}

// Corners and faces of a body, each with as many corners as it has.
TriangleMesh polyhedron(std::vector<DVec3> corners,
                        std::span<const std::vector<std::uint32_t>> faces) {
    TriangleMesh mesh;
    mesh.positions = std::move(corners);
    for (const std::vector<std::uint32_t>& face : faces)
        for (std::size_t k = 2; k < face.size(); ++k)
            mesh.faces.emplace_back(face[0], face[k - 1], face[k]);
    return mesh;
}

constexpr double kSharpAngle = 0.2, kSharpLength = 12;  // mean free paths

// Along x from a sharp edge, or from a tip.
TriangleMesh wedge(double l) {
    const double x = kSharpLength * l, z = x * std::tan(kSharpAngle / 2), y = x / 2;
    const std::vector<std::uint32_t> faces[] = {
        {0, 2, 3, 1}, {0, 1, 5, 4}, {2, 4, 5, 3}, {0, 4, 2}, {1, 3, 5}};
    return polyhedron({{0, -y, 0}, {0, y, 0}, {x, -y, z}, {x, y, z}, {x, -y, -z}, {x, y, -z}},
                      faces);
}
TriangleMesh needle(double l) {
    const double x = kSharpLength * l, z = x * std::tan(kSharpAngle / 2);
    const std::vector<std::uint32_t> faces[] = {
        {0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 4, 3, 2}};
    return polyhedron({{0, 0, 0}, {x, -z, z}, {x, z, z}, {x, z, -z}, {x, -z, -z}}, faces);
}

// Towards a tip thinner than the points are apart, light that leaves dwindles smoothly as less of
// it scatters, and is never more than that; from a thickness of half the spacing on no place stands
// out.
TEST(ShapeSolver, SharpPartsDoNotRing) {
    const DiffusionConstants medium = constantsOf("marble");
    const double l = 1 / medium.extinction.z;
    for (const bool isWedge : {true, false}) {
        const auto isSide = [](const SurfacePoint& p) {
            return std::abs(decodeUnitVector(p.normal).x) < 0.5f;
        };
        // Straight across, to the face that meets this one at the angle.
        const auto across = [&](const SurfacePoint& p) {
            return isSide(p)
                       ? double{p.position.x} * std::tan(kSharpAngle) / std::cos(kSharpAngle / 2)
                       : kSharpLength * l;
        };
        const Solved body(isWedge ? wedge(l) : needle(l), isWedge ? 0.7 * l : 0.4 * l, across,
                          medium, everywhere);
        EXPECT_TRUE(body.report.solve.converged);
        EXPECT_LT(maxComponent(body.report.negative), 1e-4);
        DRgb before{0};
        for (int step = 0; step < 7; ++step) {
            const auto isHere = [&](const SurfacePoint& p) {
                return isSide(p) && std::abs(double{p.position.y}) < 3 * l &&
                       static_cast<int>(double{p.position.x} / l) == step;
            };
            const DRgb mean = body.mean(isHere);
            const DRgb scattered =
                1.0 - glm::exp(-medium.extinction * (step + 1.0) * l * std::tan(kSharpAngle));
            for (int c = 0; c < 3; ++c) {
                EXPECT_GT(mean[c], before[c]) << isWedge << ' ' << step;
                EXPECT_LT(mean[c], 1.1 * scattered[c]) << isWedge << ' ' << step;
            }
            before = mean;
            for (std::size_t i = 0; i < body.fluence.size(); ++i)
                if (step > 1 && isHere(body.cloud.samples.points[i])) {
                    EXPECT_NEAR(body.exitance(i).y / mean.y, 1, 0.25) << isWedge << ' ' << step;
                }
        }
    }
}

}  // namespace
}  // namespace sss
