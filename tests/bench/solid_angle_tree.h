#pragma once
#include "sss/cloud/kernel_table.h"
#include "sss/cloud/octree.h"
#include "sss/cloud/point_cloud.h"
#include "sss/medium/medium.h"
#include "sss/medium/profile.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sss::bench {

/// The classic way to sum diffusion, [JB02 section 3.2], as pbrt-v2 and Mitsuba 0.6 have it: one
/// receiver at a time walks the octree; a node is taken whole, as its flux at its flux-weighted
/// centroid, if its area is seen under less than the solid angle asked for, A / |x - c|^2 < limit,
/// and the receiver is outside its box; leaves are summed point by point. Single precision, one
/// cache line a node. It stands on the same points and the same tree as ours.
class SolidAngleTree {
public:
    SolidAngleTree(const CloudView& cloud, std::span<const OctreeNode> nodes);

    struct Counts {
        std::uint64_t nodesVisited = 0, nodeInteractions = 0, pointInteractions = 0;
    };
    /// The dipole in closed form, two square roots and two exponentials a channel and interaction.
    class ClosedForm {
    public:
        /// Throws Error{BadInput} unless `profiles` are the medium's dipole to 1e-5.
        ClosedForm(const Medium& medium, const ProfileOptions& options,
                   const std::array<const Profile*, 3>& profiles);
        Rgb evaluate(float distanceSquaredMm2) const;

    private:
        float sigmaTr_[3], realHeight_[3], virtualHeight_[3], scale_[3];
    };

    /// `Kernel` is ClosedForm, or KernelTable to see the traversal alone.
    template <typename Kernel>
    Rgb evaluate(const Kernel& kernel, const Vec3& receiver, float solidAngleLimit,
                 Counts& counts) const;

private:
    struct alignas(64) Node {
        Vec3 centroid;
        float areaMm2;
        Rgb flux;
        std::uint32_t first;
        Vec3 lo;
        std::uint32_t count;  // as OctreeNode
        Vec3 hi;
    };
    struct Point {
        Vec3 position;
        Rgb flux;
    };
    std::vector<Node> nodes_;
    std::vector<Point> points_;
};

}  // namespace sss::bench
