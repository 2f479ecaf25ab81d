#include "sss/cloud/exitance_sites.h"

#include "sss/cloud/face_order.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sss {
namespace {

// Whole faces are gathered until a group has about this many sites: few enough to lie close
// together, enough to share a traversal.
constexpr std::uint32_t kSitesPerGroup = 40;
constexpr std::uint32_t kMostFacesPerGroup = 512;
constexpr double kMostCuts = 4096;
constexpr std::uint64_t kMostGroups = 1u << 26;

double longestEdge(const TriangleMesh& mesh, FaceIndex face) {
    const UVec3 v = mesh.faces[face];
    const DVec3 &a = mesh.positions[v.x], &b = mesh.positions[v.y], &c = mesh.positions[v.z];
    return std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
}

// Sites that a face adds to those it shares with its neighbours, about.
std::uint32_t ownSites(std::uint32_t segments) { return std::max(1u, segments * segments / 2); }

}  // namespace

ExitanceSites::ExitanceSites(const TriangleMesh& mesh, double segmentMm)
    : mesh_(mesh),
      segmentMm_(segmentMm),
      faces_(mesh.faceCount()),
      faceOrder_(facesInSpaceOrder(mesh)) {
    // A body so large that it would need absurdly many groups is cut more coarsely; refinement
    // still sees to the tolerance within a patch.
    std::uint64_t cutGroups = 0;
    do {
        cutGroups = 0;
        for (FaceIndex f = 0; f < mesh.faceCount(); ++f) {
            const double segments = std::max(1.0, std::ceil(longestEdge(mesh, f) / segmentMm_));
            const double cuts = std::clamp(std::ceil(segments / kMostSegments), 1.0, kMostCuts);
            faces_[f].cuts = static_cast<std::uint16_t>(cuts);
            faces_[f].segments = static_cast<std::uint8_t>(
                std::clamp(std::ceil(segments / cuts), 1.0, static_cast<double>(kMostSegments)));
            if (faces_[f].cuts > 1)
                cutGroups += std::uint64_t{faces_[f].cuts} * std::uint64_t{faces_[f].cuts};
        }
        if (cutGroups > kMostGroups) segmentMm_ *= 1.5;
    } while (cutGroups > kMostGroups);

    GroupRange open;
    std::uint32_t sites = 0;
    const auto close = [&](std::uint32_t nextFace) {
        if (open.faceCount > 0) {
            ranges_.push_back(open);
            ++groupCount_;
        }
        open = {groupCount_, nextFace, 0, false};
        sites = 0;
    };
    for (std::uint32_t k = 0; k < faceOrder_.size(); ++k) {
        FaceEntry& face = faces_[faceOrder_[k]];
        if (face.cuts > 1) {
            close(k + 1);
            face.group = groupCount_;
            ranges_.push_back({groupCount_, k, 1, true});
            groupCount_ += std::uint32_t{face.cuts} * face.cuts;
            open.firstGroup = groupCount_;
            continue;
        }
        face.group = groupCount_;
        face.slot = static_cast<std::uint16_t>(open.faceCount++);
        sites += ownSites(face.segments);
        if (sites >= kSitesPerGroup || open.faceCount >= kMostFacesPerGroup) close(k + 1);
    }
    close(static_cast<std::uint32_t>(faceOrder_.size()));
}

// The m x m patches of a face cut m times: upright ones at (column, row) with column + row < m; the
// inverted one of cell (i, j) stands at (m - 1 - i, m - 1 - j), where no upright one is.
ExitanceSites::Patch ExitanceSites::subPatch(FaceIndex face, std::uint32_t index) const {
    const std::uint32_t m = faces_[face].cuts;
    const float size = 1.0f / static_cast<float>(m);
    const std::uint32_t row = index / m, column = index % m;
    Patch patch{face, {}, {size, 0}, {0, size}, faces_[face].segments};
    if (row + column < m) {
        patch.origin = Vec2(static_cast<float>(column), static_cast<float>(row)) * size;
    } else {
        // Right angle at the far corner (i + 1, j + 1) of its cell.
        patch.origin = Vec2(static_cast<float>(m - column), static_cast<float>(m - row)) * size;
        patch.edgeU = {-size, 0};
        patch.edgeV = {0, -size};
    }
    return patch;
}

ExitanceSites::Location ExitanceSites::locate(FaceIndex face, const Vec2& barycentrics) const {
    const FaceEntry& entry = faces_[face];
    Vec2 b = glm::clamp(barycentrics, 0.0f, 1.0f);
    if (b.x + b.y > 1.0f) b = b / (b.x + b.y);
    if (entry.cuts == 1) return {entry.group, entry.slot, b};
    const std::uint32_t m = entry.cuts;
    const Vec2 scaled = b * static_cast<float>(m);
    std::uint32_t i = std::min(static_cast<std::uint32_t>(scaled.x), m - 1);
    std::uint32_t j = std::min(static_cast<std::uint32_t>(scaled.y), m - 1);
    if (i + j > m - 1) (i > 0 ? i : j) = m - 1 - (i > 0 ? j : i);
    const Vec2 inCell =
        glm::clamp(scaled - Vec2(static_cast<float>(i), static_cast<float>(j)), 0.0f, 1.0f);
    if (inCell.x + inCell.y <= 1.0f || i + j == m - 1) {
        const float excess = std::max(1.0f, inCell.x + inCell.y);
        return {entry.group + j * m + i, 0, inCell / excess};
    }
    // Inverted: stored where no upright patch stands, at column m - 1 - i, row m - 1 - j.
    return {entry.group + (m - 1 - j) * m + (m - 1 - i), 0, Vec2(1.0f) - inCell};
}

std::vector<ExitanceSites::Patch> ExitanceSites::patches(std::uint32_t group) const {
    auto range =
        std::upper_bound(ranges_.begin(), ranges_.end(), group,
                         [](std::uint32_t g, const GroupRange& r) { return g < r.firstGroup; });
    --range;
    std::vector<Patch> result;
    if (range->cut) {
        result.push_back(subPatch(faceOrder_[range->firstFace], group - range->firstGroup));
        return result;
    }
    for (std::uint32_t k = 0; k < range->faceCount; ++k) {
        const FaceIndex face = faceOrder_[range->firstFace + k];
        result.push_back({face, {0, 0}, {1, 0}, {0, 1}, faces_[face].segments});
    }
    return result;
}

Vec3 ExitanceSites::position(FaceIndex face, const Vec2& barycentrics) const {
    // Corners in order of their vertex numbers: both faces of an edge do the same arithmetic.
    struct Corner {
        std::uint32_t vertex;
        double weight;
    };
    const UVec3 v = mesh_.faces[face];
    const double x = barycentrics.x, y = barycentrics.y;
    std::array<Corner, 3> corners{{{v.x, std::max(0.0, 1.0 - x - y)}, {v.y, x}, {v.z, y}}};
    std::sort(corners.begin(), corners.end(),
              [](const Corner& a, const Corner& b) { return a.vertex < b.vertex; });
    DVec3 p{0};
    for (const Corner& c : corners) p += c.weight * mesh_.positions[c.vertex];
    return Vec3(p);
}

}  // namespace sss
