#include "sss/medium/photon_walk.h"

#include "sss/base/parallel.h"
#include "sss/medium/half_space.h"
#include "sss/medium/single_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

using namespace sss;

namespace {

PhotonProblem problemOf(const ChannelMedium& medium, Illumination illumination) {
    PhotonProblem problem;
    problem.albedo = medium.albedo();
    problem.g = medium.g;
    problem.eta = medium.eta;
    problem.illumination = illumination;
    return problem;
}

PhotonTally run(const PhotonProblem& problem, std::uint32_t photonsPerBatch) {
    PhotonTally tally;
    walkPhotons(problem, 0, 64, photonsPerBatch, tally);
    return tally;
}

#define EXPECT_WITHIN_3_SIGMA(batchMean, expected) \
    EXPECT_NEAR((batchMean).mean(), (expected), 3 * (batchMean).standardError())

TEST(PhotonWalk, VanDeHulstsSlab) {
    // van de Hulst 1980: albedo .9, optical thickness 2, g = .75, matched: .09739 and .66096.
    PhotonProblem problem = problemOf({10, 90, 0.75, 1}, Illumination::Normal);
    problem.thickness = 2;
    const PhotonTally tally = run(problem, 2000);
    EXPECT_WITHIN_3_SIGMA(tally.reflected, 0.09739);
    EXPECT_WITHIN_3_SIGMA(tally.unscattered, std::exp(-2));
    BatchMean through = tally.transmitted;
    EXPECT_NEAR(through.mean() + tally.unscattered.mean(), 0.66096,
                3 * std::hypot(through.standardError(), tally.unscattered.standardError()));
    EXPECT_LT(tally.reflected.standardError(), 0.001);
}

TEST(PhotonWalk, GiovanellisHalfSpace) {
    const PhotonTally tally = run(problemOf({10, 90, 0, 1.5}, Illumination::Normal), 2000);
    EXPECT_NEAR(0.04 + 0.96 * tally.reflected.mean(), 0.260059,
                3 * 0.96 * tally.reflected.standardError());
    EXPECT_LT(tally.reflected.standardError(), 0.002);
}

TEST(PhotonWalk, HFunctionAlbedos) {
    const ChannelMedium medium{0.1, 0.9, 0, 1};
    const PhotonTally normal = run(problemOf(medium, Illumination::Normal), 2000);
    EXPECT_WITHIN_3_SIGMA(normal.reflected, 0.41494747913082);
    EXPECT_WITHIN_3_SIGMA(normal.reflectedOnce, 0.45 * (1 - std::log(2)));
    const PhotonTally diffuse = run(problemOf(medium, Illumination::Diffuse), 2000);
    EXPECT_WITHIN_3_SIGMA(diffuse.reflected, 0.478024489228);
    const ChannelMedium bright{0.01, 0.99, 0, 1};
    EXPECT_WITHIN_3_SIGMA(run(problemOf(bright, Illumination::Normal), 500).reflected,
                          0.7527207171603);
    EXPECT_WITHIN_3_SIGMA(run(problemOf(bright, Illumination::Diffuse), 500).reflected,
                          0.794563652902);
    const PhotonTally brightest =
        run(problemOf({0.0001, 0.9999, 0, 1}, Illumination::Diffuse), 100);
    EXPECT_WITHIN_3_SIGMA(brightest.reflected, 0.977186969447);
    EXPECT_LT(brightest.reflected.standardError(), 0.003);
}

// An independent simulation of media far from diffusion's reach, printed to four digits.
TEST(PhotonWalk, DarkMeasuredMedia) {
    struct Row {
        ChannelMedium medium;
        double normal, diffuse, digit;
    };
    for (const Row& row : {Row{{0.48, 1.01, 0, 1.3}, 0.1155, 0.1246, 1e-4},       // Skin1, blue
                           Row{{0.97, 0.07, 0, 1.3}, 0.00539, 0.00592, 1e-5}}) {  // Ketchup, green
        const auto check = [&](Illumination illumination, double expected) {
            const BatchMean reflected = run(problemOf(row.medium, illumination), 2000).reflected;
            EXPECT_NEAR(reflected.mean(), expected,
                        3 * reflected.standardError() + 0.5 * row.digit);
            EXPECT_LT(reflected.standardError(), 0.012 * expected);
        };
        check(Illumination::Normal, row.normal);
        check(Illumination::Diffuse, row.diffuse);
    }
}

TEST(PhotonWalk, AgreesWithAddingDoublingAndTheSingleScatteringFormula) {
    for (const ChannelMedium& medium :
         {ChannelMedium{0.48, 1.01, 0, 1.3}, ChannelMedium{0.05, 3, 0.8, 1.4},
          ChannelMedium{0.1, 1, -0.5, 0.8}, ChannelMedium{0.97, 0.07, 0, 1.3}}) {
        const HalfSpaceTotals totals = halfSpaceTotals(medium);
        const PhotonTally normal = run(problemOf(medium, Illumination::Normal), 1000);
        const PhotonTally diffuse = run(problemOf(medium, Illumination::Diffuse), 1000);
        EXPECT_WITHIN_3_SIGMA(normal.reflected, totals.normal);
        EXPECT_WITHIN_3_SIGMA(diffuse.reflected, totals.diffuse);
        EXPECT_WITHIN_3_SIGMA(normal.reflectedOnce,
                              singleScatterAlbedo(medium, Illumination::Normal));
        EXPECT_WITHIN_3_SIGMA(diffuse.reflectedOnce,
                              singleScatterAlbedo(medium, Illumination::Diffuse));
    }
}

TEST(PhotonWalk, ForwardScatteringAgreesWithAddingDoublingAndWithTheSlabsPlainWalk) {
    // Turns that are taken together below two transport mean free paths: against the plain walk,
    // which a slab always has, here one of 40 transport mean free paths.
    const ChannelMedium medium{0.1, 0.9 / (1 - 0.85), 0.85, 1.4};
    PhotonProblem problem = problemOf(medium, Illumination::Diffuse);
    for (const double r : {0.3, 1.0, 3.0}) problem.ringEdges.push_back(r * medium.sigmaT());
    const PhotonTally together = run(problem, 2000);
    EXPECT_WITHIN_3_SIGMA(together.reflected, halfSpaceTotals(medium).diffuse);
    problem.thickness = 40 * medium.sigmaT();
    problem.seed = 2;
    const PhotonTally plain = run(problem, 2000);
    for (std::size_t i = 0; i < together.rings.size(); ++i) {
        EXPECT_NEAR(
            together.rings[i].mean(), plain.rings[i].mean(),
            3 * std::hypot(together.rings[i].standardError(), plain.rings[i].standardError()))
            << "ring " << i;
    }
    EXPECT_LT(together.rings[1].standardError(), 0.02 * together.rings[1].mean());
    EXPECT_LT(static_cast<double>(together.collisions),
              0.8 * static_cast<double>(plain.collisions));
    // Sharper peaks are costlier, but only above that depth.
    const ChannelMedium peaked{0.01, 0.99 / (1 - 0.98), 0.98, 1.3};
    EXPECT_WITHIN_3_SIGMA(run(problemOf(peaked, Illumination::Diffuse), 60).reflected,
                          halfSpaceTotals(peaked).diffuse);
}

TEST(PhotonWalk, NothingIsLostWithoutAbsorption) {
    for (const double eta : {0.8, 1.0, 1.3}) {
        const PhotonTally half = run(problemOf({0, 1, 0, eta}, Illumination::Diffuse), 50);
        EXPECT_NEAR(half.reflected.mean(), 1.0, 3 * half.reflected.standardError() + 1e-12);
        PhotonProblem slab = problemOf({0, 1, 0.5, eta}, Illumination::Normal);
        slab.thickness = 3;
        const PhotonTally tally = run(slab, 50);
        EXPECT_NEAR(tally.reflected.mean() + tally.transmitted.mean() + tally.unscattered.mean(),
                    1.0, 0.01);
    }
}

// Standard errors of both simulations together. The photons are the same in every run; of 25 rings
// one beyond 3 would be seen with every fifteenth set of them.
TEST(PhotonWalk, RingsOfMarble) {
    std::ifstream file(SSS_SHARED_DIR "/golden/radial_marble_g_montecarlo.csv");
    if (!file) GTEST_SKIP() << "no shared folder";
    struct Ring {
        double lo, hi, mean, error;
    };
    std::vector<Ring> rings;
    for (std::string line; std::getline(file, line);) {
        Ring ring{};
        double middle = 0;
        if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &ring.lo, &ring.hi, &middle,
                        &ring.mean, &ring.error) == 5) {
            rings.push_back(ring);
        }
    }
    ASSERT_GT(rings.size(), 20u);
    const ChannelMedium marble{0.0041, 2.62, 0, 1.5};
    PhotonProblem problem = problemOf(marble, Illumination::Normal);
    for (const Ring& ring : rings) problem.ringEdges.push_back(ring.hi * marble.sigmaT());
    const PhotonTally tally = run(problem, 3000);
    double chiSquared = 0;
    int used = 0;
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const double error = tally.rings[i].standardError();
        if (error > 0.1 * tally.rings[i].mean()) continue;  // too few photons for a normal law
        const double area = kPi * (rings[i].hi * rings[i].hi - rings[i].lo * rings[i].lo);
        const double expected = rings[i].mean * area / 0.96;
        const double deviation =
            (tally.rings[i].mean() - expected) / std::hypot(error, rings[i].error * area / 0.96);
        EXPECT_LE(std::abs(deviation), 3.0) << "ring " << i;
        chiSquared += deviation * deviation;
        ++used;
    }
    EXPECT_GT(used, 20);
    EXPECT_LT(chiSquared, used + 3 * std::sqrt(2.0 * used));
}

TEST(PhotonWalk, TheSameBytesOnAnyNumberOfThreads) {
    PhotonProblem problem = problemOf({0.1, 1, 0.3, 1.3}, Illumination::Diffuse);
    problem.ringEdges = {0.1, 1, 10};
    const PhotonTally many = run(problem, 100);
    const ThreadLimit one(1);
    const PhotonTally alone = run(problem, 100);
    EXPECT_EQ(many.reflected.sum, alone.reflected.sum);
    EXPECT_EQ(many.rings[1].squares, alone.rings[1].squares);
}

}  // namespace
