// Prints the table of libsss/sss/medium/README.md; some minutes, so it runs only when asked for.
#include "sss/medium/half_space.h"
#include "sss/medium/measured_media.h"
#include "sss/medium/photon_walk.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

using namespace sss;

namespace {

/// Total under diffuse light, simulated until 1 sigma is below 0.15 % of it.
BatchMean simulatedTotal(const ChannelMedium& medium) {
    PhotonProblem problem;
    problem.albedo = medium.albedo();
    problem.g = medium.g;
    problem.eta = medium.eta;
    problem.illumination = Illumination::Diffuse;
    PhotonTally tally;
    for (std::uint64_t done = 0; done < 64 * 64; done += 64) {
        walkPhotons(problem, done, 64, 1000, tally);
        if (tally.reflected.standardError() < 0.0015 * tally.reflected.mean()) break;
    }
    return tally.reflected;
}

constexpr std::array kTabledModels{"dipole", "better_dipole", "photon_beam"};

TEST(ModelTotals, DISABLED_Table) {
    std::printf("| medium | alpha' | Monte Carlo | transfer |");
    for (const char* model : kTabledModels) std::printf(" %s |", model);
    std::printf("\n|---|---|---|---|---|---|---|\n");
    for (const MeasuredMedium& measured : measuredMedia().first(12)) {
        const Medium medium = toMedium(measured);
        for (int c = 0; c < 3; ++c) {
            const ChannelMedium channel = medium.channel(c);
            const BatchMean truth = simulatedTotal(channel);
            EXPECT_NEAR(halfSpaceTotals(channel).diffuse, truth.mean(),
                        4 * truth.standardError() + 1e-9);
            const std::string name(measured.name);
            std::printf("| %s %c | %.4f | %.5f ± %.5f | %.5f |", name.c_str(), "RGB"[c],
                        channel.reducedAlbedo(), truth.mean(), truth.standardError(),
                        halfSpaceTotals(channel).diffuse);
            for (const char* model : kTabledModels) {
                double total = makeProfile(model, channel)->total();
                // The beam's multiple scattering is meant to be added to its single scattering.
                if (std::string(model) == "photon_beam") {
                    total += makeProfile("photon_beam_single", channel)->total();
                }
                std::printf(" %.5f (%+.1f %%) |", total, 100 * (total / truth.mean() - 1));
            }
            std::printf("\n");
            std::fflush(stdout);
        }
    }
}

}  // namespace
