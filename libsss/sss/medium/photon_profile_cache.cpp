#include "sss/base/atomic_file.h"
#include "sss/base/error.h"
#include "sss/base/hash.h"
#include "sss/medium/photon_profile.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

namespace sss {
namespace {

/// Changes whenever the simulation or the file's layout does.
constexpr std::uint64_t kVersion = 2;
constexpr std::string_view kMagic = "sss-photon-profile";

std::uint64_t checksumOf(std::string_view text) {
    return checksum(std::as_bytes(std::span<const char>(text)));
}

std::string write(const PhotonProfileKey& key, const PhotonProfile& profile) {
    std::string text = fmt::format("{} {} {}\n", kMagic, kVersion, key.fingerprint());
    text += fmt::format("{:.17g} {:.17g} {}\n", profile.total, profile.totalError, profile.photons);
    text += fmt::format("{:.17g} {:.17g} {}\n", profile.firstRadius, profile.stepRatio,
                        profile.logRatios.size());
    for (const double value : profile.logRatios) text += fmt::format("{:.17g}\n", value);
    return text + fmt::format("checksum {:016x}\n", checksumOf(text));
}

/// Nothing unless every byte is as it was written.
std::optional<PhotonProfile> read(const PhotonProfileKey& key, const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    std::stringstream stream;
    stream << file.rdbuf();
    const std::string text = stream.str();
    const std::size_t end = text.rfind("checksum ");
    if (end == std::string::npos) return std::nullopt;
    const std::string body = text.substr(0, end);
    if (text.substr(end) != fmt::format("checksum {:016x}\n", checksumOf(body))) {
        return std::nullopt;
    }
    std::istringstream in(body);
    std::string magic, fingerprint;
    std::uint64_t version = 0;
    std::size_t count = 0;
    PhotonProfile profile;
    in >> magic >> version >> fingerprint >> profile.total >> profile.totalError >>
        profile.photons >> profile.firstRadius >> profile.stepRatio >> count;
    if (!in || magic != kMagic || version != kVersion || fingerprint != key.fingerprint() ||
        count > 1000) {
        return std::nullopt;
    }
    profile.logRatios.resize(count);
    for (double& value : profile.logRatios) in >> value;
    if (!in) return std::nullopt;
    return profile;
}

void keep(const PhotonProfileKey& key, const PhotonProfile& profile,
          const std::filesystem::path& path) {
    try {
        std::filesystem::create_directories(path.parent_path());
        AtomicFile file(path);
        file.append(write(key, profile));
        file.commit();
    } catch (const Error&) {
    } catch (const std::filesystem::filesystem_error&) {
    }
}

}  // namespace

std::string PhotonProfileKey::fingerprint() const {
    return Hasher()
        .add(kVersion)
        .add(reducedAbsorption)
        .add(g)
        .add(eta)
        .add(static_cast<std::uint64_t>(illumination))
        .add(relativeError)
        .finish()
        .hex();
}

std::filesystem::path defaultProfileCacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0') {
        return std::filesystem::path(cache) / "sss" / "profiles";
    }
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
        return std::filesystem::path(home) / ".cache" / "sss" / "profiles";
    }
    return {};
}

PhotonProfile loadOrSimulatePhotonProfile(const PhotonProfileKey& key,
                                          const std::filesystem::path& cacheFolder) {
    if (cacheFolder.empty() || key.reducedAbsorption >= 1) return simulatePhotonProfile(key);
    const std::filesystem::path path = cacheFolder / (key.fingerprint() + ".profile");
    if (const auto kept = read(key, path)) return *kept;
    const PhotonProfile profile = simulatePhotonProfile(key);
    keep(key, profile, path);
    return profile;
}

}  // namespace sss
