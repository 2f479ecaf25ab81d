#pragma once
#include "sss/base/json.h"
#include "sss/cloud/cache_file.h"
#include "sss/integrate/cloud_sections.h"
#include "sss/integrate/preprocess.h"

#include <filesystem>
#include <span>
#include <vector>

namespace sss {

/// Inputs of the pass 1 of all bodies, each placed on its own mesh.
std::vector<BodyInputs> worldInputs(const World& world,
                                    std::span<const std::unique_ptr<BodyOptics>> optics);

struct CachedBody {
    BodyCloud::View cloud;
    const BodyReport* report;
    const BodyInputs* inputs;
};

/// Writes the clouds of all bodies, with what they were made from, as one cache file.
void writeCloudCache(const std::filesystem::path& path, const World& world,
                     std::span<const CachedBody> cached);

/// The clouds of a cache file, used where they lie in memory-mapped sections, of which only the
/// parts that somebody needs are read.
class CloudCache {
public:
    /// Opens a cache made for this world. Throws Error{BadInput} with the reason if it was made for
    /// another, Error{Io} if it cannot be read.
    /// Tells the optics of bodies with a shape whether they are seen through.
    CloudCache(const std::filesystem::path& path, const World& world,
               std::span<const std::unique_ptr<BodyOptics>> optics,
               std::span<const BodyInputs> worldInputs);
    /// The same with worldInputs().
    CloudCache(const std::filesystem::path& path, const World& world,
               std::span<const std::unique_ptr<BodyOptics>> optics);
    const BodyCloud::View& view(std::size_t body) const { return views_[body]; }
    const BodyReport& report(std::size_t body) const { return reports_[body]; }

private:
    CacheFile file_;
    std::vector<BodyCloud::View> views_;  // by body
    std::vector<BodyReport> reports_;
};

/// What a cache says of itself (format, scene, bodies), for --info. Checks all that is in it.
JsonValue describeCache(const std::filesystem::path& path);

}  // namespace sss
