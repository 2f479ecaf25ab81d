#pragma once
#include "sss/geom/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// One side of one face: the directed edge from corner `corner` to the next.
struct FaceSide {
    std::uint32_t lo = 0, hi = 0;  ///< welded vertices, lo < hi
    FaceIndex face = 0;
    std::uint8_t corner = 0;
    bool forward = true;  ///< the face runs from lo to hi
};

/// All sides of a mesh's faces, those of one edge side by side; linear time. Vertices at the same
/// position are one. Faces that use a position twice have no sides.
class EdgeTable {
public:
    explicit EdgeTable(const TriangleMesh& mesh);

    /// Calls visit(std::span<const FaceSide>) once an edge, in a fixed order.
    template <typename Visit>
    void forEachEdge(const Visit& visit) const {
        const std::span<const FaceSide> all(sides_);
        for (std::size_t begin = 0; begin < all.size();) {
            std::size_t end = begin + 1;
            while (end < all.size() && all[end].lo == all[begin].lo && all[end].hi == all[begin].hi)
                ++end;
            visit(all.subspan(begin, end - begin));
            begin = end;
        }
    }
    /// The welded corners of a face.
    UVec3 weldedFace(const UVec3& f) const { return {welded_[f.x], welded_[f.y], welded_[f.z]}; }
    const std::vector<std::uint32_t>& welded() const { return welded_; }
    static bool repeatsCorner(const UVec3& f) { return f.x == f.y || f.y == f.z || f.z == f.x; }

private:
    std::vector<std::uint32_t> welded_;
    std::vector<FaceSide> sides_;
};

/// Disjoint sets of the numbers 0 to count - 1.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count);
    /// The set's representative: its smallest member.
    std::uint32_t find(std::uint32_t member);
    void unite(std::uint32_t a, std::uint32_t b);

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace sss
