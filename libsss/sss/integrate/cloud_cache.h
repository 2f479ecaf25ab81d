#pragma once
#include "sss/base/json.h"
#include "sss/cloud/cache_file.h"
#include "sss/integrate/preprocess.h"

#include <filesystem>
#include <span>
#include <vector>

namespace sss {

/// Writes the clouds of all bodies, with what they were made from, as one cache file.
void writeCloudCache(const std::filesystem::path& path, const World& world,
                     std::span<const BodyCloud> clouds, std::span<const BodyReport> reports,
                     std::span<const std::unique_ptr<BodyOptics>> optics);

/// The clouds of a cache file, used where they lie in memory-mapped sections.
class CloudCache {
public:
    /// Opens a cache made for this world. Throws Error{BadInput} with the reason if it was made for
    /// another, Error{Io} if it cannot be read.
    CloudCache(const std::filesystem::path& path, const World& world,
               std::span<const std::unique_ptr<BodyOptics>> optics);
    BodyCloud::View view(std::size_t body) const;
    std::string fingerprint() const { return fingerprint_; }

private:
    void checkNodes(std::uint32_t body) const;

    CacheFile file_;
    std::vector<double> spacingMm_;
    std::vector<bool> wantsShape_;
    std::string fingerprint_;
};

/// What a cache says of itself (format, scene, bodies), for --info.
JsonValue describeCache(const std::filesystem::path& path);

}  // namespace sss
