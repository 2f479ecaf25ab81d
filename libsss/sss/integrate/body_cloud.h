#pragma once
#include "sss/cloud/octree.h"
#include "sss/cloud/point_cloud.h"
#include "sss/cloud/solved_exitance.h"

#include <span>
#include <vector>

namespace sss {

/// What pass 1 makes of a body: points, what enters at each, and the octree over them.
struct BodyCloud {
    std::vector<SurfacePoint> points;
    std::vector<Rgb> irradiance;
    std::vector<OctreeNode> nodes;
    double spacingMm = 0;
    /// By point: diffusion on the body's own shape; empty where the profile is all.
    std::vector<SolvedExitance> solved;

    struct View {
        CloudView cloud;
        std::span<const OctreeNode> nodes;
        double spacingMm = 0;
        std::span<const SolvedExitance> solved;
    };
    View view() const { return {{points, irradiance}, nodes, spacingMm, solved}; }
};

}  // namespace sss
