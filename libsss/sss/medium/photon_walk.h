#pragma once
#include "sss/medium/profile.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace sss {

/// A homogeneous half-space or slab with smooth boundaries, lit at one point; lengths in mean free
/// paths 1/sigma_t.
struct PhotonProblem {
    double albedo = 1;  ///< sigma_s / sigma_t, in [0, 1]
    double g = 0;       ///< Henyey-Greenstein, in (-1, 1)
    double eta = 1;     ///< inside over outside, > 0; the same on both faces of a slab
    double thickness = std::numeric_limits<double>::infinity();
    Illumination illumination = Illumination::Normal;
    std::vector<double> ringEdges;  ///< ascending radii between which reflected light is counted
    std::uint64_t seed = 1;
};

/// Mean and standard error from independent batches, as a sum and a sum of squares.
struct BatchMean {
    double sum = 0, squares = 0;
    std::uint64_t batches = 0;

    void add(double value);
    double mean() const;
    /// 1 sigma; infinite with fewer than two batches.
    double standardError() const;
};

/// Shares of the transmitted flux.
struct PhotonTally {
    BatchMean reflected;      ///< leaves through the lit face, however often scattered
    BatchMean reflectedOnce;  ///< the part scattered exactly once
    BatchMean transmitted;    ///< leaves through the far face after scattering
    BatchMean unscattered;    ///< leaves through the far face without
    /// Reflected within the first edge, between edges, beyond the last: size edges + 1.
    std::vector<BatchMean> rings;
    std::uint64_t photons = 0;
    std::uint64_t collisions = 0;  ///< what the walk cost
};

/// Photon Monte Carlo with implicit capture and with the boundary split by Fresnel's formulas, so
/// that no event is lost to chance where its share is known. Adds batches [first, first + count) of
/// `photonsPerBatch` photons to `tally`: bytes depend on the problem and the numbers only, never on
/// threads. Where 1 - alpha' < 1e-5, light deeper than 30 transport mean free paths is followed by
/// diffusion (its error there is below 1e-4 of the total); without absorption everything that is
/// not transmitted is reflected. In a half-space with g > 0.6 the many small turns deeper than two
/// transport mean free paths are taken together: by the phase function (1 + cos)^n, with the n and
/// the rate for which the first two angular moments relax as they do in the medium, which takes two
/// to three collisions a transport mean free path, whatever g is (delta-Eddington's idea [JWW76]
/// with a positive phase function; tests hold it to what the plain walk gives).
void walkPhotons(const PhotonProblem& problem, std::uint64_t first, std::uint64_t count,
                 std::uint32_t photonsPerBatch, PhotonTally& tally);

}  // namespace sss
