#pragma once
#include "sss/integrate/cloud_cache.h"

namespace sss::testing {

/// Writes what pass 1 made of a world as one cache file.
inline void writeCache(const std::filesystem::path& path, const World& world,
                       std::span<const std::unique_ptr<BodyOptics>> optics,
                       std::span<const BodyCloud> clouds, std::span<const BodyReport> reports) {
    const std::vector<BodyInputs> inputs = worldInputs(world, optics);
    std::vector<CachedBody> cached;
    for (std::size_t b = 0; b < inputs.size(); ++b)
        cached.push_back({clouds[b].view(), &reports[b], &inputs[b]});
    writeCloudCache(path, world, cached);
}

}  // namespace sss::testing
