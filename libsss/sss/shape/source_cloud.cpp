#include "sss/shape/source_cloud.h"

namespace sss {

SourceCloud::SourceCloud(std::span<const VolumeSource> sources) {
    std::vector<Vec3> positions;
    positions.reserve(sources.size());
    for (const VolumeSource& source : sources) positions.push_back(source.position);
    points_.reserve(sources.size());
    power_.reserve(sources.size());
    for (const std::uint32_t i : mortonOrder(positions)) {
        points_.push_back({.position = sources[i].position, .areaMm2 = 1.0f});
        power_.push_back(sources[i].power);
    }
    nodes_ = buildOctree(view());
}

std::vector<SourceCloud> SourceCloud::byKind(std::span<const VolumeSource> sources) {
    std::vector<std::vector<VolumeSource>> kinds;
    for (const VolumeSource& source : sources) {
        if (source.kind >= kinds.size()) kinds.resize(source.kind + 1);
        kinds[source.kind].push_back(source);
    }
    std::vector<SourceCloud> clouds;
    for (const std::vector<VolumeSource>& kind : kinds)
        if (!kind.empty()) clouds.emplace_back(kind);
    return clouds;
}

}  // namespace sss
