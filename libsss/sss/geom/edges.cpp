#include "sss/geom/edges.h"

#include "sss/geom/weld.h"

#include <algorithm>
#include <numeric>

namespace sss {

namespace {

template <typename Visit>
void forEachSide(const TriangleMesh& mesh, const std::vector<std::uint32_t>& welded,
                 const Visit& visit) {
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face) {
        const UVec3 f = mesh.faces[face];
        const std::array<std::uint32_t, 3> v{welded[f.x], welded[f.y], welded[f.z]};
        if (EdgeTable::repeatsCorner({v[0], v[1], v[2]})) continue;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = v[corner], b = v[(corner + 1) % 3];
            visit(FaceSide{std::min(a, b), std::max(a, b), face, static_cast<std::uint8_t>(corner),
                           a < b});
        }
    }
}

}  // namespace

EdgeTable::EdgeTable(const TriangleMesh& mesh) : welded_(weldPositions(mesh.positions)) {
    // Counting sort by the lower vertex, then a sort of each short bucket.
    std::vector<std::size_t> bucket(mesh.positions.size() + 1, 0);
    forEachSide(mesh, welded_, [&](const FaceSide& side) { ++bucket[side.lo + 1]; });
    std::partial_sum(bucket.begin(), bucket.end(), bucket.begin());
    sides_.resize(bucket.back());
    std::vector<std::size_t> next(bucket.begin(), bucket.end() - 1);
    forEachSide(mesh, welded_, [&](const FaceSide& side) { sides_[next[side.lo]++] = side; });
    for (std::size_t v = 0; v + 1 < bucket.size(); ++v) {
        const auto begin = sides_.begin() + static_cast<std::ptrdiff_t>(bucket[v]);
        const auto end = sides_.begin() + static_cast<std::ptrdiff_t>(bucket[v + 1]);
        std::sort(begin, end, [](const FaceSide& a, const FaceSide& b) {
            return a.hi != b.hi ? a.hi < b.hi : a.face < b.face;
        });
    }
}

DisjointSets::DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
}

std::uint32_t DisjointSets::find(std::uint32_t member) {
    while (parent_[member] != member) {
        parent_[member] = parent_[parent_[member]];
        member = parent_[member];
    }
    return member;
}

void DisjointSets::unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
}

}  // namespace sss
