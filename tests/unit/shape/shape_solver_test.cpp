// Bodies for which the diffusion equation has a closed form.
#include "sss/shape/shape_solver.h"

#include "cloud_tools.h"
#include "sss/geom/shapes.h"
#include "sss/shape/depth_rule.h"
#include "sss/shape/screened_green.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace sss {
namespace {

using testing::LitCloud;
using testing::Optics;

DiffusionConstants constantsOf(std::string_view medium) {
    const Optics optics(medium);
    return diffusionConstants(optics.medium, exactFresnelMoments(optics.medium.eta));
}

// A body lit along its normals, or only where they look up, and its solution.
struct Solved {
    LitCloud cloud;
    DiffusionConstants medium;
    std::vector<VolumeSource> sources;
    std::vector<DRgb> fluence;
    DRgb entered{0};
    ShapeReport report;

    Solved(const TriangleMesh& mesh, double spacing, double depthMm, const DiffusionConstants& m,
           const std::function<bool(const Vec3& normal)>& isLit)
        : cloud(mesh, spacing, testing::white), medium(m) {
        const DepthRule rule(medium);
        std::vector<DepthRule::Node> nodes;
        rule.append(depthMm, nodes);
        for (const SurfacePoint& p : cloud.samples.points) {
            const Vec3 normal = decodeUnitVector(p.normal);
            if (!isLit(normal)) continue;
            const DRgb power(static_cast<double>(p.areaMm2));
            entered += power;
            for (const DepthRule::Node& node : nodes)
                sources.push_back({p.position - normal * static_cast<float>(node.depthMm),
                                   Rgb(power * node.weight * medium.reducedAlbedo)});
        }
        const double reach = 1.01 * mesh.bounds().diagonal();
        const ShapeSolver solver(cloud.view(), cloud.nodes, medium, cloud.spacingMm, reach);
        fluence.assign(cloud.samples.size(), 0.5 * medium.impedance);
        report = solver.solve(sources, 1e-3, fluence);
    }
    DRgb exitance(std::size_t i) const { return fluence[i] / medium.impedance; }
    // Mean over the points that `counts` says, weighted by area.
    DRgb mean(const std::function<bool(const SurfacePoint&)>& counts) const {
        DRgb sum{0};
        double area = 0;
        for (std::size_t i = 0; i < fluence.size(); ++i) {
            const SurfacePoint& p = cloud.samples.points[i];
            if (!counts(p)) continue;
            sum += exitance(i) * static_cast<double>(p.areaMm2);
            area += p.areaMm2;
        }
        return sum / area;
    }
    double spread(const DRgb& mean) const {
        double squares = 0;
        for (std::size_t i = 0; i < fluence.size(); ++i)
            squares += std::pow(exitance(i).y / mean.y - 1, 2);
        return std::sqrt(squares / static_cast<double>(fluence.size()));
    }
};

const auto everywhere = [](const auto&) { return true; };

// Light that scatters first at depth s, over the share u(s) of it that leaves where asked:
// integral of alpha' sigma'_t exp(-sigma'_t s) u(s) over [0, length].
double fromDepths(const DiffusionConstants& m, int c, double length,
                  const std::function<double(double)>& u) {
    constexpr int kSteps = 4000;
    const double end = std::min(length, 40 / m.extinction[c]), step = end / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double s = (i + 0.5) * step;
        sum += m.extinction[c] * std::exp(-m.extinction[c] * s) * u(s) * step;
    }
    return m.reducedAlbedo[c] * sum;
}

// By reciprocity the share of a source at radius r that leaves a ball is the regular solution
// i(r) = sinh(k r) / (k r) of lap(i) = k^2 i, scaled to i + b di/dr = 1 on the boundary.
double ballExitance(const DiffusionConstants& m, int c, double radius) {
    const double k = m.screening[c], x = k * radius;
    const auto i = [&](double r) {
        return k * r > 1e-6 ? std::sinh(k * r) / (k * r) : 1 + k * k * r * r / 6;
    };
    const double slope = (std::cosh(x) - i(radius)) / radius;
    const double norm = i(radius) + m.boundaryMm[c] * slope;
    return fromDepths(m, c, 2 * radius, [&](double s) { return i(std::abs(radius - s)) / norm; });
}

class Ball : public ::testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(Ball, MatchesTheClosedForm) {
    const auto [name, radiusPerMfp] = GetParam();
    const DiffusionConstants medium = constantsOf(name);
    const double l = 1 / medium.extinction.z, radius = radiusPerMfp * l;
    // Strong absorption wants denser points, as pass 1 makes them.
    const double densest = medium.screening.z > 0.5 * medium.extinction.z ? 0.2 : 1.0;
    const Solved ball(makeSphere(radius, 6), std::min(densest, radiusPerMfp / 4) * l, 2 * radius,
                      medium, everywhere);
    EXPECT_TRUE(ball.report.solve.converged);
    const DRgb mean = ball.mean(everywhere);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean[c] / ballExitance(medium, c, radius), 1, 5e-3) << "channel " << c;
    // No place differs from the others.
    EXPECT_LT(ball.spread(mean), 8e-3);
}

INSTANTIATE_TEST_SUITE_P(Shape, Ball,
                         ::testing::Values(std::pair{"marble", 0.5}, std::pair{"marble", 2.0},
                                           std::pair{"marble", 6.0}, std::pair{"marble", 20.0},
                                           std::pair{"skimmilk", 1.0}, std::pair{"ketchup", 3.0}));

// The same in one dimension: u = A exp(k z) + B exp(-k z), u - b u' = 1 at the lit face, u + b u' =
// 0 at the other.
double slabShare(const DiffusionConstants& m, int c, double thickness, double z) {
    const double k = m.screening[c], bk = m.boundaryMm[c] * k, far = std::exp(k * thickness);
    const double determinant = (1 - bk) * (1 - bk) / far - (1 + bk) * (1 + bk) * far;
    return ((1 - bk) / far * std::exp(k * z) - (1 + bk) * far * std::exp(-k * z)) / determinant;
}

TEST(Slab, MatchesTheClosedForm) {
    const DiffusionConstants medium = constantsOf("marble");
    const double l = 1 / medium.extinction.z;
    for (const double perMfp : {2.0, 5.0}) {
        // Wide, since light wanders far: the middle is looked at.
        const double thickness = perMfp * l, width = 70 * l;
        const Solved slab(makeBox(DVec3(width, width, thickness)), 1.0 * l, thickness, medium,
                          [](const Vec3& n) { return n.z > 0.9f; });
        const auto middle = [&](float side) {
            return [&, side](const SurfacePoint& p) {
                return std::abs(p.position.x) < width / 8 && std::abs(p.position.y) < width / 8 &&
                       p.position.z * side > 0;
            };
        };
        const DRgb back = slab.mean(middle(1)), through = slab.mean(middle(-1));
        for (int c = 0; c < 3; ++c) {
            const auto share = [&](double z) { return slabShare(medium, c, thickness, z); };
            const double reflected = fromDepths(medium, c, thickness, share);
            const double passed =
                fromDepths(medium, c, thickness, [&](double z) { return share(thickness - z); });
            // At spacings of half the thickness the faces' own samples show; half as far apart they
            // do not (0.4 %).
            const double allowed = perMfp < 3 ? 0.03 : 0.01;
            EXPECT_NEAR(back[c] / reflected, 1, allowed) << perMfp;
            EXPECT_NEAR(through[c] / passed, 1, allowed) << perMfp;
        }
    }
}

// What does not leave is absorbed: by the fluence inside, from the boundary's.
TEST(ShapeSolver, ConservesEnergy) {
    Medium absorbing;
    absorbing.sigmaS = {2, 1, 1};
    absorbing.sigmaA = {0.05, 0.1, 0.2};
    absorbing.eta = 1.3;
    const DiffusionConstants medium = diffusionConstants(absorbing, exactFresnelMoments(1.3));
    const double l = 1 / medium.extinction.y, radius = 3 * l;
    const Solved ball(makeSphere(radius, 6), 0.3 * l, 2 * radius, medium, everywhere);
    const double cell = ball.cloud.spacingMm / std::sqrt(kPi);
    const ScreenedGreen r(medium.screening.x, 3 * radius), g(medium.screening.y, 3 * radius),
        b(medium.screening.z, 3 * radius);
    const KernelTable green({&r, &g, &b}, 3 * radius, 0.5 * cell);
    ChargeTree tree(ball.cloud.view(), ball.cloud.nodes);
    tree.setFluence(ball.fluence, 1.0 / medium.boundaryMm);
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
    DRgb scattered{0};
    for (const VolumeSource& source : ball.sources) scattered += DRgb(source.power);
    const DRgb leaves = ball.mean(everywhere) * static_cast<double>(makeSphere(radius, 6).area());
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR((leaves[c] + absorbed[c]) / scattered[c], 1, 5e-3) << "channel " << c;
}

// Loose and tight tolerances differ by less than the loose one.
TEST(ShapeSolver, KeepsItsTolerance) {
    for (const char* name : {"marble", "ketchup"}) {
        const DiffusionConstants medium = constantsOf(name);
        const double l = 1 / medium.extinction.z, radius = 8 * l;
        const auto isLit = [](const Vec3& n) { return n.x > 0; };
        const Solved fine(makeSphere(radius, 6), 0.8 * l, 2 * radius, medium, isLit);
        std::vector<DRgb> loose = fine.fluence;
        // A guess that is right to a factor of a few, as the profile's is.
        for (DRgb& v : loose) v = glm::max(v * DRgb(0.7, 1.4, 1.0), DRgb(1e-5));
        const ShapeSolver solver(fine.cloud.view(), fine.cloud.nodes, medium, fine.cloud.spacingMm,
                                 2.02 * radius);
        solver.solve(fine.sources, 0.02, loose);
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

// Two sheets closer together than the points: a few times what scatters there, which is little.
TEST(ShapeSolver, ThinPartsStayBounded) {
    const DiffusionConstants medium = constantsOf("marble");
    const double l = 1 / medium.extinction.z;
    for (const double thickness : {0.3 * l, 0.03 * l, 1e-4 * l}) {
        const Solved leaf(makeBox(DVec3(12 * l, 12 * l, thickness)), 1.0 * l, thickness, medium,
                          [](const Vec3& n) { return n.z > 0.9f; });
        const DRgb scattered =
            medium.reducedAlbedo * (1.0 - glm::exp(-medium.extinction * thickness));
        for (std::size_t i = 0; i < leaf.fluence.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                EXPECT_TRUE(std::isfinite(leaf.fluence[i][c]));
                EXPECT_GT(leaf.exitance(i)[c], -2 * scattered[c]);
                EXPECT_LT(leaf.exitance(i)[c], 4 * scattered[c]);
            }
    }
}

}  // namespace
}  // namespace sss
