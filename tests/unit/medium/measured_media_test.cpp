#include "sss/medium/measured_media.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace sss;

namespace {

std::vector<std::string> fields(const std::string& line) {
    std::vector<std::string> parts;
    std::stringstream stream(line);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
}

TEST(MeasuredMedia, AgreeWithTheSharedTable) {
    std::ifstream file(SSS_SHARED_DIR "/materials.csv");
    if (!file) GTEST_SKIP() << "no shared folder";
    std::string line;
    std::getline(file, line);
    std::size_t rows = 0;
    while (std::getline(file, line)) {
        const auto f = fields(line);
        const MeasuredMedium* medium = findMeasuredMedium(f[0]);
        ASSERT_NE(medium, nullptr) << f[0];
        const auto number = [&](std::size_t i) {
            return f[i].empty() ? 0.0 : std::strtod(f[i].c_str(), nullptr);
        };
        EXPECT_EQ(medium->eta, number(15)) << f[0];
        EXPECT_EQ(medium->hasScattering, !f[16].empty()) << f[0];
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(medium->sigmaSPrime[c], number(3 + c)) << f[0];
            EXPECT_EQ(medium->sigmaA[c], number(6 + c)) << f[0];
            EXPECT_EQ(medium->sigmaS[c], number(16 + c)) << f[0];
            EXPECT_EQ(medium->g[c], number(19 + c)) << f[0];
        }
        ++rows;
    }
    EXPECT_EQ(rows, measuredMedia().size());
}

TEST(MeasuredMedia, RowsTranscribedASecondTime) {
    const MeasuredMedium* marble = findMeasuredMedium("marble");
    ASSERT_NE(marble, nullptr);
    EXPECT_EQ(marble->sigmaSPrime, (std::array{2.19, 2.62, 3.00}));
    EXPECT_EQ(marble->sigmaA, (std::array{0.0021, 0.0041, 0.0071}));
    EXPECT_EQ(marble->eta, 1.5);
    const MeasuredMedium* milk = findMeasuredMedium("REGULAR-milk");
    ASSERT_NE(milk, nullptr);
    EXPECT_EQ(milk->sigmaS, (std::array{18.2052, 20.3826, 22.3698}));
    EXPECT_EQ(milk->g, (std::array{0.75, 0.714, 0.681}));
    EXPECT_EQ(findMeasuredMedium("skin_1")->sigmaA[2], 0.48);
    EXPECT_EQ(findMeasuredMedium("granite"), nullptr);
    EXPECT_EQ(measuredMedia().size(), 47u);
}

TEST(MeasuredMedia, ReducedScatteringAgreesWithScatteringAndG) {
    for (const MeasuredMedium& medium : measuredMedia()) {
        if (!medium.hasScattering) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const double reduced = (1 - medium.g[c]) * medium.sigmaS[c];
            // g is printed to three decimals, sigma_s to five.
            EXPECT_NEAR(reduced, medium.sigmaSPrime[c], 5.1e-4 * medium.sigmaS[c] + 1e-5)
                << medium.name;
        }
    }
}

TEST(MeasuredMedia, BecomeMedia) {
    const Medium marble = toMedium(*findMeasuredMedium("Marble"));
    EXPECT_EQ(marble.g, DRgb(0));
    EXPECT_EQ(marble.sigmaS.y, 2.62);
    EXPECT_NEAR(marble.smallestMeanFreePathMm(), 1 / 3.0071, 1e-15);
    EXPECT_NEAR(marble.meanFreePathMm().x, 1 / 2.1921, 1e-15);
    const Medium milk = toMedium(*findMeasuredMedium("Regular Milk"));
    EXPECT_EQ(milk.g.x, 0.75);
    EXPECT_NEAR(milk.channel(0).sigmaSPrime(), 4.5513, 1e-3);
}

TEST(MeasuredMedia, WarningsNameTheReason) {
    const Medium marble = toMedium(*findMeasuredMedium("Marble"));
    EXPECT_TRUE(diffusionWarnings(marble, 50).empty());
    const auto thin = diffusionWarnings(marble, 1);
    ASSERT_EQ(thin.size(), 1u);
    EXPECT_NE(thin[0].find("thin"), std::string::npos);
    EXPECT_NE(thin[0].find("mean free paths"), std::string::npos);
    const auto dark = diffusionWarnings(toMedium(*findMeasuredMedium("Ketchup")), 1000);
    ASSERT_EQ(dark.size(), 1u);
    EXPECT_NE(dark[0].find("red, green, blue"), std::string::npos);
    EXPECT_NE(dark[0].find("albedo"), std::string::npos);
    const auto clear = diffusionWarnings(toMedium(*findMeasuredMedium("Merlot")), 1000);
    EXPECT_NE(clear.at(0).find("green, blue"), std::string::npos);
    EXPECT_NE(clear.at(0).find("sigma_s = 0"), std::string::npos);
    Medium diamond = marble;
    diamond.eta = 3;
    EXPECT_TRUE(diffusionWarnings(diamond, 50).empty());
    const auto papers = diffusionWarnings(diamond, 50, BoundaryModel::Polynomial);
    ASSERT_EQ(papers.size(), 1u);
    EXPECT_NE(papers[0].find("0.5 to 2.4"), std::string::npos);
    EXPECT_TRUE(diffusionWarnings(marble, 50, BoundaryModel::Polynomial).empty());
}

}  // namespace
