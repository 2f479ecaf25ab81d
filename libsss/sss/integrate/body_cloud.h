#pragma once
#include "sss/cloud/octree.h"
#include "sss/cloud/point_cloud.h"

#include <span>
#include <vector>

namespace sss {

/// What pass 1 makes of a body: points, what enters at each, and the octree over them.
struct BodyCloud {
    std::vector<SurfacePoint> points;
    std::vector<Rgb> irradiance;
    std::vector<OctreeNode> nodes;
    double spacingMm = 0;
    /// By point: exitance by diffusion on the body's own shape less that by the profile; empty
    /// where the profile is all.
    std::vector<Rgb> correction;

    struct View {
        CloudView cloud;
        std::span<const OctreeNode> nodes;
        double spacingMm = 0;
        std::span<const Rgb> correction;
    };
    View view() const { return {{points, irradiance}, nodes, spacingMm, correction}; }
};

}  // namespace sss
