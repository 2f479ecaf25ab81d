// Bodies for which the diffusion equation has a closed form.
#include "sss/shape/shape_solver.h"

#include "cloud_tools.h"
#include "sss/geom/shapes.h"
#include "sss/optics/fresnel.h"
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

using Where = std::function<bool(const SurfacePoint&)>;

// A body lit along its normals where asked, and its solution.
struct Solved {
    LitCloud cloud;
    DiffusionConstants medium;
    std::vector<VolumeSource> sources;
    std::vector<DRgb> fluence;
    DRgb entered{0};
    ShapeReport report;

    Solved(const TriangleMesh& mesh, double spacing, double depthMm, const DiffusionConstants& m,
           const Where& isLit)
        : cloud(mesh, spacing, testing::white), medium(m) {
        const DepthRule rule(medium);
        std::vector<DepthRule::Node> nodes;
        rule.append(depthMm, nodes);
        for (const SurfacePoint& p : cloud.samples.points) {
            if (!isLit(p)) continue;
            const Vec3 normal = decodeUnitVector(p.normal);
            const DRgb power(static_cast<double>(p.areaMm2));
            entered += power;
            for (std::uint32_t k = 0; k < nodes.size(); ++k)
                sources.push_back({p.position - normal * static_cast<float>(nodes[k].depthMm),
                                   Rgb(power * nodes[k].weight * medium.reducedAlbedo), k});
        }
        const double reach = 1.01 * mesh.bounds().diagonal();
        const ShapeSolver solver(cloud.view(), cloud.nodes, medium, cloud.spacingMm, reach, 1e-3);
        fluence.assign(cloud.samples.size(), 0.5 * medium.impedance);
        report = solver.solve(sources, fluence);
    }
    DRgb exitance(std::size_t i) const { return fluence[i] / medium.impedance; }
    // Mean over the points that `counts` says, weighted by area.
    DRgb mean(const Where& counts) const {
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
const auto fromAbove = [](const SurfacePoint& p) { return decodeUnitVector(p.normal).z > 0.9f; };

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
                                           std::pair{"skimmilk", 1.0}, std::pair{"skimmilk", 10.0},
                                           std::pair{"ketchup", 3.0}));

// Two concentric spheres, the inner one wound inward. Of a source at radius r leave through a wall:
// u = (A exp(k (r - at)) + B exp(-k (r - at))) / r with u + b du/dr = 1 outside (or 0), u - b du/dr
// = 0 inside (or 1).
double shellShare(const DiffusionConstants& m, int c, double inner, double outer, bool outward,
                  double r) {
    const double k = m.screening[c], b = m.boundaryMm[c];
    // Value plus or minus b times the slope of exp(s k (r - inner)) / r at `at`.
    const auto row = [&](double s, double at, double sign) {
        const double value = std::exp(s * k * (at - inner)) / at;
        return value + sign * b * value * (s * k - 1 / at);
    };
    const double a1 = row(1, outer, 1), b1 = row(-1, outer, 1);
    const double a2 = row(1, inner, -1), b2 = row(-1, inner, -1);
    const double right1 = outward ? 1 : 0, right2 = outward ? 0 : 1;
    const double determinant = a1 * b2 - b1 * a2;
    const double a = (right1 * b2 - b1 * right2) / determinant;
    const double d = (a1 * right2 - right1 * a2) / determinant;
    return (a * std::exp(k * (r - inner)) + d * std::exp(-k * (r - inner))) / r;
}

// A hollow ball, lit from outside and from inside.
TEST(Shell, MatchesTheClosedForm) {
    const DiffusionConstants medium = constantsOf("marble");
    const double l = 1 / medium.extinction.z, inner = 4 * l, outer = 8 * l;
    TriangleMesh mesh = makeSphere(outer, 6);
    TriangleMesh wall = makeSphere(inner, 6);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.normals.clear();
    mesh.positions.insert(mesh.positions.end(), wall.positions.begin(), wall.positions.end());
    for (const UVec3& f : wall.faces) mesh.faces.push_back(UVec3(f.x, f.z, f.y) + first);
    const auto isOutside = [&](const SurfacePoint& p) {
        return static_cast<double>(glm::length(p.position)) > 6 * l;
    };
    const auto isInside = [&](const SurfacePoint& p) { return !isOutside(p); };
    for (const bool litOutside : {true, false}) {
        const Solved shell(mesh, 0.7 * l, outer - inner, medium,
                           litOutside ? Where(isOutside) : Where(isInside));
        EXPECT_TRUE(shell.report.solve.converged);
        const double lit = litOutside ? outer : inner;
        for (const bool outward : {true, false}) {
            const DRgb mean = shell.mean(outward ? Where(isOutside) : Where(isInside));
            const double wallRadius = outward ? outer : inner;
            for (int c = 0; c < 3; ++c) {
                const double share = fromDepths(medium, c, outer - inner, [&](double s) {
                    return shellShare(medium, c, inner, outer, outward,
                                      litOutside ? outer - s : inner + s);
                });
                const double expected = share * lit * lit / (wallRadius * wallRadius);
                EXPECT_NEAR(mean[c] / expected, 1, 0.005)
                    << (litOutside ? "lit outside, " : "lit inside, ")
                    << (outward ? "seen outside" : "seen inside");
            }
        }
    }
}

// The same in one dimension: u = A exp(k z) + B exp(-k z), u - b u' = 1 at the lit face, u + b u' =
// 0 at the other.
double slabShare(const DiffusionConstants& m, int c, double thickness, double z) {
    const double k = m.screening[c], bk = m.boundaryMm[c] * k, far = std::exp(k * thickness);
    const double determinant = (1 - bk) * (1 - bk) / far - (1 + bk) * (1 + bk) * far;
    return ((1 - bk) / far * std::exp(k * z) - (1 + bk) * far * std::exp(-k * z)) / determinant;
}

// Radiative transfer, green channel: a beam along the normal, already inside; shares of it by an
// independent Monte Carlo of 2 million photons, standard error 0.0004. `straight` passes without
// scattering.
struct KnownSlab {
    const char* medium;
    double perMfp, reflected, passed, straight;
};

class Slab : public ::testing::TestWithParam<KnownSlab> {};

TEST_P(Slab, MatchesTheClosedFormAndRadiativeTransfer) {
    const KnownSlab& known = GetParam();
    const DiffusionConstants medium = constantsOf(known.medium);
    const double l = 1 / medium.extinction.y, thickness = known.perMfp * l;
    // Wide, since light wanders far: the middle is looked at.
    const double width = 4.5 * (thickness + 4 * l);
    // Faces four points apart, or their own samples show; of a thick one, points as far apart as
    // the shortest mean free path.
    const double spacing = std::min(thickness / 4, 1 / medium.extinction.z);
    const Solved slab(makeBox(DVec3(width, width, thickness)), spacing, thickness, medium,
                      fromAbove);
    const auto middle = [&](float side) {
        return [&, side](const SurfacePoint& p) {
            return std::abs(p.position.x) < width / 12 && std::abs(p.position.y) < width / 12 &&
                   p.position.z * side > 0;
        };
    };
    const DRgb back = slab.mean(middle(1)), through = slab.mean(middle(-1));
    for (int c = 0; c < 3; ++c) {
        const auto share = [&](double z) { return slabShare(medium, c, thickness, z); };
        const double reflected = fromDepths(medium, c, thickness, share);
        const double passed =
            fromDepths(medium, c, thickness, [&](double z) { return share(thickness - z); });
        EXPECT_NEAR(back[c] / reflected, 1, 0.01) << "channel " << c;
        EXPECT_NEAR(through[c] / passed, 1, 0.01) << "channel " << c;
    }
    // What the far face reflects of the beam (4 % of it and less) scatters as well, and lies on the
    // other side by as much.
    const double mirror = fresnelReflectance(1.0, Optics(known.medium).medium.eta);
    const double mirrored = known.straight * mirror / (1 - mirror);
    EXPECT_NEAR((back.y + mirrored * through.y) / known.reflected, 1, 0.03);
    EXPECT_NEAR((through.y + mirrored * back.y + known.straight) / known.passed, 1, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Shape, Slab,
                         ::testing::Values(KnownSlab{"marble", 2, 0.4602, 0.5250, 0.1299},
                                           KnownSlab{"marble", 5, 0.6242, 0.3383, 0.0064},
                                           KnownSlab{"marble", 10, 0.7246, 0.2034, 0},
                                           // 2 mm
                                           KnownSlab{"skimmilk", 2.445, 0.5156, 0.4672, 0.0849}));

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

}  // namespace
}  // namespace sss
