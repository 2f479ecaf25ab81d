#pragma once
#include "sss/cloud/octree.h"
#include "sss/cloud/point_cloud.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// A place inside a body where light scatters for the first time.
struct VolumeSource {
    Vec3 position{};  ///< mm, body space
    Rgb power{0.0f};  ///< W m^-2 mm^2, as of irradiance x area
    /// Sources of a kind stand at like depths along their beams: their colours differ as the
    /// light's do, not with depth.
    std::uint32_t kind = 0;
    /// The point that its beam came from, straight; kNowhere if it was reflected on its way.
    std::uint32_t from = kNowhere;
    static constexpr std::uint32_t kNowhere = 0xffffffffu;
};

/// Sources of one kind as the sums over points take them: points of unit area. A node of the octree
/// has one place for all channels; of kinds mixed, whose channels stand at different depths, hardly
/// a node could be taken whole.
class SourceCloud {
public:
    /// Sorts them; O(N log N), deterministic.
    explicit SourceCloud(std::span<const VolumeSource> sources);
    /// One for each kind.
    static std::vector<SourceCloud> byKind(std::span<const VolumeSource> sources);
    CloudView view() const { return {points_, power_}; }
    std::span<const OctreeNode> nodes() const { return nodes_; }

private:
    std::vector<SurfacePoint> points_;
    std::vector<Rgb> power_;
    std::vector<OctreeNode> nodes_;
};

}  // namespace sss
