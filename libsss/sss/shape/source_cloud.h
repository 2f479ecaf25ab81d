#pragma once
#include "sss/cloud/octree.h"
#include "sss/cloud/point_cloud.h"

#include <span>
#include <vector>

namespace sss {

/// A place inside a body where light scatters for the first time.
struct VolumeSource {
    Vec3 position{};  ///< mm, body space
    Rgb power{0.0f};  ///< W m^-2 mm^2, as of irradiance x area
};

/// Sources as the sums over points take them: points of unit area.
class SourceCloud {
public:
    /// Sorts them; O(N log N), deterministic.
    explicit SourceCloud(std::span<const VolumeSource> sources);
    CloudView view() const { return {points_, power_}; }
    std::span<const OctreeNode> nodes() const { return nodes_; }

private:
    std::vector<SurfacePoint> points_;
    std::vector<Rgb> power_;
    std::vector<OctreeNode> nodes_;
};

}  // namespace sss
