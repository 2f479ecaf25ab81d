// The tree of charges against the sum over all points, and vector code against plain.
#include "sss/shape/layer_sum.h"

#include "cloud_tools.h"
#include "sss/base/parallel.h"
#include "sss/geom/shapes.h"
#include "sss/shape/screened_green.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using testing::LitCloud;

constexpr double kReach = 13;

struct Layers {
    LitCloud cloud{makeSphere(6, 1), 0.4, testing::white};
    ScreenedGreen red{0.0, kReach}, green{0.3, kReach}, blue{1.5, kReach};
    KernelTable table{{&red, &green, &blue}, kReach, cloud.spacingMm / std::sqrt(kPi)};
    DRgb perLength{0.8, 1, 1.6};
    ChargeTree tree{cloud.view(), cloud.nodes};
    std::vector<DRgb> fluence;

    // Of both signs, as the vectors of an iteration are; less leaves on one side.
    Layers() {
        std::vector<DRgb> here;
        for (const SurfacePoint& p : cloud.samples.points) {
            fluence.emplace_back(1 + 0.5 * p.position.x, p.position.y, std::cos(p.position.z));
            here.push_back(perLength * (0.6 + 0.4 * p.position.y / 6));
        }
        tree.setFluence(fluence, here);
    }
    LayerSum sum() const { return {tree, table, perLength}; }
    std::vector<DRgb> atPoints(const Rgb& allowed, LayerCounts& counts) const {
        std::vector<DRgb> out(fluence.size());
        sum().atPoints(std::vector<Rgb>(fluence.size(), allowed), out, counts);
        return out;
    }
};

TEST(LayerSum, KeepsWhatIsAllowed) {
    const Layers layers;
    const std::size_t n = layers.fluence.size();
    for (const float allowed : {0.3f, 0.03f, 0.01f}) {
        LayerCounts counts;
        const std::vector<DRgb> out = layers.atPoints(Rgb(allowed), counts);
        double worst = 0, squares = 0;
        std::size_t checked = 0;
        for (std::size_t i = 0; i < n; i += 7, ++checked) {
            const DRgb error =
                out[i] - layers.sum().bruteForce(layers.cloud.samples.points[i].position);
            worst = std::max(worst, maxComponent(glm::abs(error)));
            squares += glm::dot(error, error) / 3;
        }
        EXPECT_LE(worst, allowed);
        EXPECT_LE(std::sqrt(squares / static_cast<double>(checked)), allowed / 3);
        EXPECT_LT(counts.interactions(), n * n);
    }
}

TEST(LayerSum, NothingAllowedIsTheSumOverAll) {
    const Layers layers;
    LayerCounts counts;
    const std::vector<DRgb> out = layers.atPoints(Rgb(0), counts);
    double most = 0;
    for (const DRgb& v : out) most = std::max(most, glm::length(v));
    // As sums of two terms a point in single precision round.
    const double rounding = std::sqrt(2.0 * static_cast<double>(out.size())) * 0x1p-24 * most;
    for (std::size_t i = 0; i < out.size(); i += 31)
        EXPECT_LT(
            glm::length(out[i] - layers.sum().bruteForce(layers.cloud.samples.points[i].position)),
            rounding);
}

TEST(LayerSum, VectorCodeAgreesWithPlain) {
    const Layers layers;
    LayerList list;
    for (std::uint32_t i = 0; i < 90; ++i) list.nodes.push_back(3 * i);
    for (std::uint32_t i = 0; i < 70; ++i) list.points.push_back(5 * i);
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < 9; ++i)
        places.push_back(layers.cloud.samples.points[i * 40].position * 1.4f);
    std::vector<DRgb> fast(9, DRgb(1)), plain(9, DRgb(1));
    accumulateLayers(layers.tree, layers.table, list, places, fast);
    accumulateLayersScalar(layers.tree, layers.table, list, places, plain);
    for (std::size_t i = 0; i < 9; ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(fast[i][c], plain[i][c], 1e-4);
}

// An expansion is what its nodes add near its centre, by vector code and plain.
TEST(LayerSum, ExpansionsAreTheNodesSeenFromNearby) {
    const Layers layers;
    LayerList list;
    for (std::uint32_t i = 20; i < 90; ++i) list.locals.push_back(i);
    const Vec3 centre(2, -20, 14);
    LocalExpansion fast{.centre = centre}, plain{.centre = centre};
    expandLayers(layers.tree, layers.table, list, fast);
    expandLayersScalar(layers.tree, layers.table, list, plain);
    LayerList same;
    same.nodes = list.locals;
    for (const Vec3& away : {Vec3(0), Vec3(0.1f, 0, 0), Vec3(-0.05f, 0.1f, 0.1f)}) {
        const Vec3 place = centre + away;
        DRgb exact(0);
        accumulateLayersScalar(layers.tree, layers.table, same, std::span(&place, 1),
                               std::span(&exact, 1));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(fast.at(place)[c], plain.at(place)[c], 1e-5 * std::abs(exact[c]) + 1e-7);
            EXPECT_NEAR(plain.at(place)[c], exact[c], 2e-3 * std::abs(exact[c]) + 1e-6);
        }
    }
}

TEST(LayerSum, SameBytesWithAnyNumberOfThreads) {
    const Layers layers;
    LayerCounts counts;
    const std::vector<DRgb> many = layers.atPoints(Rgb(0.01f), counts);
    const ThreadLimit one(1);
    EXPECT_EQ(many, layers.atPoints(Rgb(0.01f), counts));
}

// Gauss: a closed surface fills half of what a smooth place of it sees.
TEST(LayerSum, ClosedSurfacesFillHalfTheView) {
    const LitCloud cloud(makeSphere(6, 1), 0.4, testing::white);
    const ScreenedGreen green(0, kReach);
    const KernelTable table({&green, &green, &green}, kReach, cloud.spacingMm / std::sqrt(kPi));
    ChargeTree tree(cloud.view(), cloud.nodes);
    tree.setFluence(std::vector<DRgb>(cloud.samples.size(), DRgb(1)),
                    std::vector<DRgb>(cloud.samples.size(), DRgb(0)));
    const LayerSum sum(tree, table, DRgb(0));
    // The centre sees all of it; a place outside nothing.
    EXPECT_NEAR(sum.bruteForce(Vec3(0)).x, -1, 1e-3);
    EXPECT_NEAR(sum.bruteForce(Vec3(0, 6.9f, 0)).x, 0, 3e-3);
    for (std::size_t i = 0; i < cloud.samples.size(); i += 50)
        EXPECT_NEAR(sum.bruteForce(cloud.samples.points[i].position).x, -0.5, 0.015);
}

TEST(ScreenedGreen, TailIsTheIntegralOverAPlane) {
    for (const double k : {0.0, 1e-9, 0.2, 3.0}) {
        const ScreenedGreen green(k, 10);
        for (const double a : {0.0, 0.5, 9.0, 11.0}) {
            double sum = 0;
            constexpr int kSteps = 20000;
            const double width = std::max(0.0, 10 - a) / kSteps;
            for (int i = 0; i < kSteps; ++i) {
                const double r = a + (i + 0.5) * width;
                sum += 2 * kPi * r * green.reflectance(r) * width;
            }
            EXPECT_NEAR(green.tail(a), sum, 1e-6 * sum + 1e-12) << k << " " << a;
        }
    }
}

}  // namespace
}  // namespace sss
