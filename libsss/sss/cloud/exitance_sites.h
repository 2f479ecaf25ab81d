#pragma once
#include "sss/base/vec.h"
#include "sss/geom/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Where radiant exitance is computed and how it is interpolated: a regular grid of sites on every
/// face (the "mesh colours" of Yuksel et al. 2010), n segments along each edge. Faces with many
/// segments are cut into patches of at most kMostSegments.
///
/// Patches are gathered in groups: all patches of a group are computed together, in one traversal
/// of the octree, the first time that any of them is asked for. Groups depend on the mesh and the
/// segment length only, never on who asks, so that values do not depend on the camera.
class ExitanceSites {
public:
    static constexpr std::uint32_t kMostSegments = 8;

    /// `segmentMm`: wanted length of a segment before refinement.
    ExitanceSites(const TriangleMesh& mesh, double segmentMm);

    std::uint32_t groupCount() const { return groupCount_; }
    double segmentMm() const { return segmentMm_; }

    /// A patch: the corners of a sub-triangle of a face, in barycentrics (second, third corner).
    struct Patch {
        FaceIndex face = 0;
        Vec2 origin{0}, edgeU{1, 0}, edgeV{0, 1};
        std::uint32_t segments = 1;
        /// Barycentrics of the face at a place in the patch.
        Vec2 at(const Vec2& inPatch) const {
            return origin + edgeU * inPatch.x + edgeV * inPatch.y;
        }
    };
    /// Where a place on the mesh lies: which group and patch of it, and the place in the patch.
    struct Location {
        std::uint32_t group, patch;
        Vec2 inPatch;
    };
    Location locate(FaceIndex face, const Vec2& barycentrics) const;
    /// The patches of a group, in their order.
    std::vector<Patch> patches(std::uint32_t group) const;
    /// Position in body space, mm; the same bits for the same place seen from two faces.
    Vec3 position(FaceIndex face, const Vec2& barycentrics) const;

private:
    struct FaceEntry {
        std::uint32_t group = 0;    // of its only patch, or of its first
        std::uint16_t slot = 0;     // of its only patch within the group
        std::uint16_t cuts = 1;     // patches along an edge
        std::uint8_t segments = 1;  // of a patch
    };
    Patch subPatch(FaceIndex face, std::uint32_t index) const;

    const TriangleMesh& mesh_;
    double segmentMm_;
    std::uint32_t groupCount_ = 0;
    std::vector<FaceEntry> faces_;
    // Groups made of whole faces: runs of faceOrder_. Groups of cut faces hold one patch each and
    // follow from `groupFace_` (the face) and the difference to its first group.
    std::vector<FaceIndex> faceOrder_;
    struct GroupRange {
        std::uint32_t firstGroup = 0, firstFace = 0, faceCount = 0;
        bool cut = false;
    };
    std::vector<GroupRange> ranges_;  // ascending firstGroup
};

}  // namespace sss
