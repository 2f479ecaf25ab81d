#pragma once
#include "sss/geom/edges.h"
#include "sss/geom/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace sss {

/// What it takes to turn every face the right way; nothing is changed yet.
struct WindingPlan {
    static constexpr std::uint32_t kNoComponent = 0xffffffffu;
    struct Component {
        std::size_t faces = 0;
        bool closed = false;       ///< every edge has exactly two faces
        bool orientable = true;    ///< false: no winding suits all its faces (a Moebius strip)
        bool turned = false;       ///< all its faces are to be flipped
        std::size_t minority = 0;  ///< faces that disagreed with the rest
        double volume = 0;         ///< signed, about its own centre, as planned
        DBounds bounds;
    };
    std::vector<std::uint32_t> componentOfFace;  ///< kNoComponent for faces that repeat a position
    std::vector<Component> components;           ///< joined by edges of exactly two faces
    std::vector<bool> flip;                      ///< by face
};

/// Makes the faces of each component agree (keeping the side with more area), then turns closed
/// components by their signed volume: outward, but inward for those nested inside an odd number of
/// other closed components (the inner wall of a hollow body). Open components are turned outward if
/// they enclose a meaningful volume about their centre: above 1 % of area^1.5 (a sphere has 9.4 %);
/// flatter ones keep the winding of most of their area. Edges of three or more faces separate
/// components. Near linear, but for nesting, where each component is tested against those whose
/// boxes enclose its own. `edges` are the mesh's.
WindingPlan planWinding(const TriangleMesh& mesh, const EdgeTable& edges);
inline WindingPlan planWinding(const TriangleMesh& mesh) {
    return planWinding(mesh, EdgeTable(mesh));
}

}  // namespace sss
