#pragma once
#include "sss/medium/profile.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sss {

/// What one simulation of a half-space leaves behind: its total, and by how much it differs from
/// photon beam diffusion ring by ring. Lengths in transport mean free paths.
struct PhotonProfile {
    double total = 0;       ///< share of the transmitted flux that returns
    double totalError = 0;  ///< 1 sigma
    std::uint64_t photons = 0;
    double firstRadius = 0;  ///< of the first value below
    double stepRatio = 0;    ///< from value to value
    /// Smoothed log of (simulated / beam diffusion), one value a ring.
    std::vector<double> logRatios;
};

/// What a simulation depends on; any two media with equal keys have the same PhotonProfile.
struct PhotonProfileKey {
    double reducedAbsorption = 0;  ///< 1 - alpha'
    double g = 0;
    double eta = 1;
    Illumination illumination = Illumination::Diffuse;
    double relativeError = 0.003;  ///< 1 sigma of the total

    /// Hexadecimal name of the cache file.
    std::string fingerprint() const;
};

/// Simulates until the total's standard error is below `relativeError` (and the median ring's below
/// five times that), at least 64,000 photons, or until a billion collisions (40 s of one core,
/// which only g > 0.9 needs), whatever comes first; `totalError` is what was reached. The ring
/// values are smoothed by the stiffest curve that the statistics allow (third differences, chi^2 =
/// count). Deterministic, whatever the number of threads.
PhotonProfile simulatePhotonProfile(const PhotonProfileKey& key);

/// $XDG_CACHE_HOME/sss/profiles or ~/.cache/sss/profiles; empty if neither variable is set.
std::filesystem::path defaultProfileCacheFolder();

/// From the cache folder if a whole and current file is there; else simulated and, if the folder
/// can be written, kept (a folder that cannot be written costs time, nothing else).
PhotonProfile loadOrSimulatePhotonProfile(const PhotonProfileKey& key,
                                          const std::filesystem::path& cacheFolder);

}  // namespace sss
