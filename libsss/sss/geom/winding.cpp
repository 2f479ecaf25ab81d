#include "sss/geom/winding.h"

#include "sss/base/parallel.h"

#include <algorithm>

namespace sss {

namespace {

/// A face's up to three neighbours over edges of exactly two faces.
struct Neighbours {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::array<FaceIndex, 3> face{kNone, kNone, kNone};
    std::array<bool, 3> agrees{true, true, true};
};

std::vector<Neighbours> findNeighbours(const TriangleMesh& mesh, const EdgeTable& edges) {
    std::vector<Neighbours> all(mesh.faces.size());
    edges.forEachEdge([&](std::span<const FaceSide> sides) {
        if (sides.size() != 2) return;
        const bool agree = sides[0].forward != sides[1].forward;
        for (std::size_t i = 0; i < 2; ++i) {
            const FaceSide &own = sides[i], &other = sides[1 - i];
            all[own.face].face[own.corner] = other.face;
            all[own.face].agrees[own.corner] = agree;
        }
    });
    return all;
}

using Component = WindingPlan::Component;

/// Six times the signed volume between a face and `centre`.
double volume6(const TriangleMesh& mesh, const UVec3& f, const DVec3& centre) {
    return glm::dot(mesh.positions[f.x] - centre,
                    glm::cross(mesh.positions[f.y] - centre, mesh.positions[f.z] - centre));
}

/// The winding number of one component around a point: the sum of its faces' solid angles
/// [Van Oosterom & Strackee 1983], over 4 pi.
double windingNumber(const TriangleMesh& mesh, const std::vector<FaceIndex>& faces,
                     const WindingPlan& plan, const DVec3& p) {
    double sum = 0;
    for (FaceIndex face : faces) {
        const UVec3 f = mesh.faces[face];
        const DVec3 a = mesh.positions[f.x] - p, b = mesh.positions[f.y] - p,
                    c = mesh.positions[f.z] - p;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        const double angle = 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                              la * lb * lc + glm::dot(a, b) * lc +
                                                  glm::dot(b, c) * la + glm::dot(c, a) * lb);
        sum += plan.flip[face] ? -angle : angle;
    }
    return sum / (4.0 * kPi);
}

class Planner {
public:
    Planner(const TriangleMesh& mesh, const EdgeTable& edges)
        : mesh_(mesh), edges_(edges), neighbours_(findNeighbours(mesh, edges_)) {
        plan_.componentOfFace.assign(mesh.faces.size(), WindingPlan::kNoComponent);
        plan_.flip.assign(mesh.faces.size(), false);
    }

    WindingPlan run() {
        for (FaceIndex face = 0; face < mesh_.faces.size(); ++face)
            if (plan_.componentOfFace[face] == WindingPlan::kNoComponent &&
                !EdgeTable::repeatsCorner(edges_.weldedFace(mesh_.faces[face])))
                collect(face);
        for (std::size_t i = 0; i < members_.size(); ++i) measure(i);
        orientNested();
        return std::move(plan_);
    }

private:
    /// Floods one component from `seed` and makes its faces agree.
    void collect(FaceIndex seed) {
        const auto id = static_cast<std::uint32_t>(plan_.components.size());
        Component component;
        component.closed = true;
        std::vector<FaceIndex> faces{seed};
        plan_.componentOfFace[seed] = id;
        double area = 0, flippedArea = 0;
        std::size_t flipped = 0;
        for (std::size_t at = 0; at < faces.size(); ++at) {
            const FaceIndex face = faces[at];
            const Neighbours& next = neighbours_[face];
            for (std::size_t side = 0; side < 3; ++side) {
                const FaceIndex other = next.face[side];
                if (other == Neighbours::kNone) {
                    component.closed = false;
                    continue;
                }
                const bool flip = plan_.flip[face] == next.agrees[side];
                if (plan_.componentOfFace[other] == WindingPlan::kNoComponent) {
                    plan_.componentOfFace[other] = id;
                    plan_.flip[other] = flip;
                    faces.push_back(other);
                } else if (plan_.flip[other] != flip) {
                    component.orientable = false;
                }
            }
            area += mesh_.faceArea(face);
            if (plan_.flip[face]) flippedArea += mesh_.faceArea(face), ++flipped;
        }
        component.faces = faces.size();
        component.minority = flipped;
        if (!component.orientable) {
            for (FaceIndex face : faces) plan_.flip[face] = false;
        } else if (flippedArea > area - flippedArea) {
            for (FaceIndex face : faces) plan_.flip[face] = !plan_.flip[face];
            component.minority = faces.size() - flipped;
        }
        plan_.components.push_back(component);
        members_.push_back(std::move(faces));
    }

    /// Volume and bounds; turns components with a meaningful volume outward.
    void measure(std::size_t id) {
        Component& component = plan_.components[id];
        double area = 0;
        DVec3 centre{0};
        for (FaceIndex face : members_[id]) {
            const UVec3 f = mesh_.faces[face];
            for (int c = 0; c < 3; ++c) component.bounds.add(mesh_.positions[f[c]]);
            const double faceArea = mesh_.faceArea(face);
            // Relative to one of its points: a small part far from the origin must not lose digits.
            const DVec3& origin = mesh_.positions[mesh_.faces[members_[id][0]].x];
            centre += ((mesh_.positions[f.x] - origin) + (mesh_.positions[f.y] - origin) +
                       (mesh_.positions[f.z] - origin)) *
                      (faceArea / 3.0);
            area += faceArea;
        }
        if (!(area > 0)) return;
        centre = centre / area + mesh_.positions[mesh_.faces[members_[id][0]].x];
        double six = 0;
        for (FaceIndex face : members_[id])
            six += (plan_.flip[face] ? -1.0 : 1.0) * volume6(mesh_, mesh_.faces[face], centre);
        component.volume = six / 6.0;
        const double meaningful = component.closed ? 0 : 0.01 * area * std::sqrt(area);
        if (component.orientable && component.volume < -meaningful) turn(id);
    }

    void turn(std::size_t id) {
        Component& component = plan_.components[id];
        for (FaceIndex face : members_[id]) plan_.flip[face] = !plan_.flip[face];
        component.turned = !component.turned;
        component.volume = -component.volume;
    }

    bool encloses(std::size_t outer, std::size_t inner) const {
        const Component &a = plan_.components[outer], &b = plan_.components[inner];
        if (outer == inner || !a.closed || !a.orientable) return false;
        for (int axis = 0; axis < 3; ++axis)
            if (b.bounds.lo[axis] < a.bounds.lo[axis] || b.bounds.hi[axis] > a.bounds.hi[axis])
                return false;
        const UVec3 f = mesh_.faces[members_[inner][0]];
        const DVec3 p = (mesh_.positions[f.x] + mesh_.positions[f.y] + mesh_.positions[f.z]) / 3.0;
        return std::abs(windingNumber(mesh_, members_[outer], plan_, p)) > 0.5;
    }

    /// Turns inward what lies inside an odd number of closed components.
    void orientNested() {
        std::vector<char> inward(members_.size(), 0);
        parallelFor(members_.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t id = begin; id < end; ++id) {
                if (!plan_.components[id].closed || !plan_.components[id].orientable) continue;
                std::size_t depth = 0;
                for (std::size_t outer = 0; outer < members_.size(); ++outer)
                    depth += encloses(outer, id) ? 1 : 0;
                inward[id] = depth % 2 == 1;
            }
        });
        for (std::size_t id = 0; id < members_.size(); ++id)
            if (inward[id]) turn(id);
    }

    const TriangleMesh& mesh_;
    const EdgeTable& edges_;
    std::vector<Neighbours> neighbours_;
    WindingPlan plan_;
    std::vector<std::vector<FaceIndex>> members_;
};

}  // namespace

WindingPlan planWinding(const TriangleMesh& mesh, const EdgeTable& edges) {
    return Planner(mesh, edges).run();
}

}  // namespace sss
