#pragma once
#include "sss/cloud/surface_cells.h"

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

namespace sss {

/// The nearest other points of every point, nearest first: what its cell is cut by.
class NeighbourLists {
public:
    explicit NeighbourLists(const CellSeeds& seeds);

    /// The first of them, usually enough.
    std::span<const std::uint32_t> of(std::uint32_t point) const {
        return std::span(indices_).subspan(point * count_, count_);
    }

private:
    std::size_t count_;
    std::vector<std::uint32_t> indices_;
};

/// What a run of faces was cut into.
struct FacePieces {
    std::vector<CellPiece> pieces;
    std::vector<Vec2> corners;
};

/// The points whose cells reach a face, each once, in the order in which they were found. A face
/// may be reached by a few points or, where it is a whole side of a body, by millions.
class ReachedPoints {
public:
    void reset(std::uint32_t first);
    /// Does nothing if the point is among them.
    void add(std::uint32_t point);
    std::size_t size() const { return order_.size(); }
    std::uint32_t operator[](std::size_t i) const { return order_[i]; }

private:
    std::vector<std::uint32_t> order_;
    std::unordered_set<std::uint32_t> known_;  // empty while there are few
};

/// Cuts faces into the cells of points (see makeSurfaceCells). One a thread.
class FaceClipper {
public:
    FaceClipper(const TriangleMesh& mesh, const CellSeeds& seeds, const NeighbourLists& neighbours);
    /// Appends the pieces of `faces`, in their order.
    void clip(std::span<const FaceIndex> faces, FacePieces& out);

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    struct Corner {
        DVec3 position;
        DVec2 barycentrics;
        std::uint32_t across;  // the point whose cell lies beyond the edge to the next corner
    };
    void clipFace(FaceIndex face, std::uint32_t seed, FacePieces& out);
    /// Cuts polygon_, which starts as the whole face, down to the cell of `point`.
    void cutCell(std::uint32_t point, const DVec3& faceNormal);
    /// The same by a longer list; false once that is all points.
    bool cutBy(std::uint32_t point, std::span<const std::uint32_t> others, const DVec3& faceNormal);
    void cutAway(const DVec3& point, std::uint32_t other);
    double reachSquared(const DVec3& point) const;
    bool faces(std::uint32_t point, const DVec3& normal) const {
        return glm::dot(DVec3(seeds_.normals[point]), normal) > 0;
    }
    /// The nearest point to each face's middle that faces the same way; kNone where none near does.
    std::vector<std::uint32_t> seedsOf(std::span<const FaceIndex> faces,
                                       std::vector<std::uint32_t>& nearest) const;

    const TriangleMesh& mesh_;
    const CellSeeds& seeds_;
    const NeighbourLists& neighbours_;
    std::vector<Corner> polygon_, spare_;
    ReachedPoints reached_;  // by the face at hand
};

}  // namespace sss
