#include "sss/cloud/face_clipper.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

// On a plane a cell has six neighbours and needs to look at about a dozen; on thin parts half of
// those found face the other way.
constexpr std::size_t kListLength = 16;
constexpr std::size_t kSeedCandidates = 4;
// Pieces smaller than this share of their face are rounding.
constexpr double kSmallestShare = 1e-9;
// Up to so many reached points a look through them all is quicker than a hash.
constexpr std::size_t kFewReached = 64;

}  // namespace

void ReachedPoints::reset(std::uint32_t first) {
    order_.assign(1, first);
    if (!known_.empty()) known_.clear();  // which costs as much as it has room
}

void ReachedPoints::add(std::uint32_t point) {
    if (order_.size() < kFewReached) {
        if (std::find(order_.begin(), order_.end(), point) == order_.end()) order_.push_back(point);
        return;
    }
    if (known_.empty()) known_.insert(order_.begin(), order_.end());
    if (known_.insert(point).second) order_.push_back(point);
}

NeighbourLists::NeighbourLists(const CellSeeds& seeds)
    : count_(std::min(kListLength + 1, seeds.positions.size())) {
    indices_.resize(count_ * seeds.positions.size());
    seeds.nearest.query(seeds.positions, count_, indices_);
}

FaceClipper::FaceClipper(const TriangleMesh& mesh, const CellSeeds& seeds,
                         const NeighbourLists& neighbours)
    : mesh_(mesh), seeds_(seeds), neighbours_(neighbours) {}

void FaceClipper::clip(std::span<const FaceIndex> faces, FacePieces& out) {
    std::vector<std::uint32_t> nearest;
    const std::vector<std::uint32_t> seeds = seedsOf(faces, nearest);
    for (std::size_t k = 0; k < faces.size(); ++k) {
        if (seeds[k] != kNone) {
            clipFace(faces[k], seeds[k], out);
            continue;
        }
        out.pieces.push_back({nearest[k], faces[k], static_cast<std::uint32_t>(out.corners.size()),
                              3, mesh_.faceArea(faces[k])});
        out.corners.insert(out.corners.end(), {{0, 0}, {1, 0}, {0, 1}});
    }
}

std::vector<std::uint32_t> FaceClipper::seedsOf(std::span<const FaceIndex> faceRun,
                                                std::vector<std::uint32_t>& nearest) const {
    std::vector<Vec3> middles;
    for (const FaceIndex f : faceRun) {
        const UVec3 v = mesh_.faces[f];
        middles.emplace_back((mesh_.positions[v.x] + mesh_.positions[v.y] + mesh_.positions[v.z]) /
                             3.0);
    }
    std::vector<std::uint32_t> result(faceRun.size(), kNone), found;
    nearest.resize(faceRun.size());
    const auto choose = [&](std::size_t k, std::span<const std::uint32_t> candidates) {
        nearest[k] = candidates[0];
        const DVec3 normal = mesh_.faceCross(faceRun[k]);
        for (const std::uint32_t p : candidates)
            if (faces(p, normal)) {
                result[k] = p;
                return;
            }
    };
    const std::size_t count = std::min(kSeedCandidates, seeds_.positions.size());
    found.resize(middles.size() * count);
    seeds_.nearest.query(middles, count, found);
    for (std::size_t k = 0; k < middles.size(); ++k) {
        choose(k, std::span(found).subspan(k * count, count));
        if (result[k] != kNone) continue;
        std::vector<std::uint32_t> more(std::min(16 * kSeedCandidates, seeds_.positions.size()));
        seeds_.nearest.query(std::span(middles).subspan(k, 1), more.size(), more);
        choose(k, more);
    }
    return result;
}

void FaceClipper::clipFace(FaceIndex face, std::uint32_t seed, FacePieces& out) {
    const DVec3 normal = mesh_.faceCross(face);
    const double faceArea = mesh_.faceArea(face);
    const UVec3 v = mesh_.faces[face];
    const std::size_t firstPiece = out.pieces.size();
    double covered = 0;
    reached_.reset(seed);
    for (std::size_t next = 0; next < reached_.size(); ++next) {
        polygon_ = {{mesh_.positions[v.x], {0, 0}, kNone},
                    {mesh_.positions[v.y], {1, 0}, kNone},
                    {mesh_.positions[v.z], {0, 1}, kNone}};
        cutCell(reached_[next], normal);
        if (polygon_.size() < 3) continue;
        double share = 0;  // of the face, whose area is 1/2 in barycentrics
        for (std::size_t k = 1; k + 1 < polygon_.size(); ++k) {
            const DVec2 a = polygon_[k].barycentrics - polygon_[0].barycentrics,
                        b = polygon_[k + 1].barycentrics - polygon_[0].barycentrics;
            share += std::abs(a.x * b.y - a.y * b.x);
        }
        for (const Corner& corner : polygon_)
            if (corner.across != kNone) reached_.add(corner.across);
        if (!(share > kSmallestShare)) continue;
        covered += share;
        out.pieces.push_back({reached_[next], face, static_cast<std::uint32_t>(out.corners.size()),
                              static_cast<std::uint32_t>(polygon_.size()), share});
        for (const Corner& corner : polygon_) out.corners.push_back(Vec2(corner.barycentrics));
    }
    if (out.pieces.size() == firstPiece) {
        out.pieces.push_back(
            {seed, face, static_cast<std::uint32_t>(out.corners.size()), 3, faceArea});
        out.corners.insert(out.corners.end(), {{0, 0}, {1, 0}, {0, 1}});
        return;
    }
    // What rounding has lost or counted twice is shared out, so that areas add up.
    for (std::size_t k = firstPiece; k < out.pieces.size(); ++k)
        out.pieces[k].areaMm2 *= faceArea / covered;
}

void FaceClipper::cutCell(std::uint32_t point, const DVec3& faceNormal) {
    if (!cutBy(point, neighbours_.of(point), faceNormal)) return;
    // Many sheets close together, or a lonely point: more neighbours, until they are far enough.
    std::vector<std::uint32_t> more;
    for (std::size_t count = 4 * kListLength;; count *= 4) {
        more.resize(std::min(count, seeds_.positions.size()));
        seeds_.nearest.query(seeds_.positions.subspan(point, 1), more.size(), more);
        if (!cutBy(point, more, faceNormal) || more.size() == seeds_.positions.size()) return;
    }
}

// True if a neighbour beyond the list could still cut.
bool FaceClipper::cutBy(std::uint32_t point, std::span<const std::uint32_t> others,
                        const DVec3& faceNormal) {
    const DVec3 centre(seeds_.positions[point]);
    double reach = reachSquared(centre);
    for (const std::uint32_t other : others) {
        const DVec3 rival(seeds_.positions[other]);
        const DVec3 d = rival - centre;
        if (glm::dot(d, d) > 4 * reach) return false;
        if (other == point || !faces(other, faceNormal)) continue;
        cutAway(centre, other);
        if (polygon_.size() < 3) return false;
        reach = reachSquared(centre);
    }
    return others.size() < seeds_.positions.size();
}

double FaceClipper::reachSquared(const DVec3& point) const {
    double reach = 0;
    for (const Corner& corner : polygon_) {
        const DVec3 d = corner.position - point;
        reach = std::max(reach, glm::dot(d, d));
    }
    return reach;
}

// Keeps the part of the polygon that is nearer to `point` [Sutherland & Hodgman 1974].
void FaceClipper::cutAway(const DVec3& point, std::uint32_t other) {
    // Once is enough: the edge's own rounding would put corners somewhere along it.
    for (const Corner& corner : polygon_)
        if (corner.across == other) return;
    const DVec3 rival(seeds_.positions[other]);
    const DVec3 axis = rival - point, middle = 0.5 * (rival + point);
    const auto beyond = [&](const Corner& corner) {
        return glm::dot(corner.position - middle, axis);
    };
    bool isCut = false;
    for (const Corner& corner : polygon_) isCut = isCut || beyond(corner) > 0;
    if (!isCut) return;
    spare_.clear();
    for (std::size_t k = 0; k < polygon_.size(); ++k) {
        const Corner &a = polygon_[k], &b = polygon_[k + 1 < polygon_.size() ? k + 1 : 0];
        const double outA = beyond(a), outB = beyond(b);
        if (outA <= 0) spare_.push_back(a);
        if ((outA <= 0) == (outB <= 0)) continue;
        const double t = outA / (outA - outB);
        spare_.push_back({glm::mix(a.position, b.position, t),
                          glm::mix(a.barycentrics, b.barycentrics, t),
                          outA <= 0 ? other : a.across});
    }
    std::swap(polygon_, spare_);
}

}  // namespace sss
