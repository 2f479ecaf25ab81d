#include "sss/geom/mesh_report.h"

#include "sss/geom/edges.h"
#include "sss/geom/mesh_repair.h"
#include "sss/geom/winding.h"

#include <fmt/core.h>

#include <algorithm>

namespace sss {

namespace {

struct OpenEdge {
    std::uint32_t a, b;
};

/// Groups open edges that share vertices, and keeps the longest groups.
void measureLoops(const TriangleMesh& mesh, const std::vector<OpenEdge>& open, MeshReport& report) {
    DisjointSets sets(mesh.positions.size());
    for (const OpenEdge& e : open) sets.unite(e.a, e.b);
    std::vector<OpenLoop> loops(mesh.positions.size());
    for (const OpenEdge& e : open) {
        const DVec3 a = mesh.positions[e.a], b = mesh.positions[e.b];
        const double length = glm::distance(a, b);
        OpenLoop& loop = loops[sets.find(e.a)];
        ++loop.edges;
        loop.length += length;
        loop.centre += (a + b) * (0.5 * length);
        report.openLength += length;
    }
    std::erase_if(loops, [](const OpenLoop& loop) { return loop.edges == 0; });
    report.openLoops = loops.size();
    const std::size_t kept = std::min(loops.size(), MeshReport::kLoopsKept);
    const auto end = loops.begin() + static_cast<std::ptrdiff_t>(kept);
    std::partial_sort(loops.begin(), end, loops.end(),
                      [](const OpenLoop& a, const OpenLoop& b) { return a.length > b.length; });
    loops.erase(end, loops.end());
    for (OpenLoop& loop : loops)
        if (loop.length > 0) loop.centre /= loop.length;
    report.longestLoops = std::move(loops);
}

void inspectEdges(const TriangleMesh& mesh, const EdgeTable& edges, MeshReport& report) {
    std::vector<OpenEdge> open;
    bool everyEdgeEven = true;
    edges.forEachEdge([&](std::span<const FaceSide> sides) {
        const FaceSide& first = sides[0];
        if (sides.size() % 2 != 0) everyEdgeEven = false;
        if (sides.size() == 1) open.push_back({first.lo, first.hi});
        if (sides.size() == 2 && first.forward == sides[1].forward) ++report.inconsistentEdges;
        if (sides.size() > 2 && report.nonManifoldEdges++ == 0)
            report.nonManifoldPlace = 0.5 * (mesh.positions[first.lo] + mesh.positions[first.hi]);
    });
    report.openEdges = open.size();
    report.closed = everyEdgeEven && !mesh.faces.empty();
    if (!open.empty()) measureLoops(mesh, open, report);
}

void inspectWinding(const TriangleMesh& mesh, const EdgeTable& edges, MeshReport& report) {
    const WindingPlan plan = planWinding(mesh, edges);
    report.components = plan.components.size();
    for (const WindingPlan::Component& component : plan.components) {
        report.closedComponents += component.closed ? 1 : 0;
        report.flippedComponents += component.turned ? 1 : 0;
        report.nonOrientable += component.orientable ? 0 : 1;
    }
    report.flippedFaces =
        static_cast<std::size_t>(std::count(plan.flip.begin(), plan.flip.end(), true));
}

std::size_t countUnreferenced(const TriangleMesh& mesh) {
    std::vector<bool> used(mesh.positions.size(), false);
    for (const UVec3& f : mesh.faces)
        for (int c = 0; c < 3; ++c) used[f[c]] = true;
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
}

/// "1 face", "2 faces".
std::string counted(std::size_t count, const char* one, const char* many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string place(const DVec3& p, double mmPerUnit) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) mm", p.x * mmPerUnit, p.y * mmPerUnit,
                       p.z * mmPerUnit);
}

}  // namespace

std::string describeHoles(const MeshReport& r, double mmPerUnit) {
    std::string list;
    for (const OpenLoop& loop : r.longestLoops)
        list += fmt::format("{}{}, {:.4g} mm around {}", list.empty() ? "" : "; ",
                            counted(loop.edges, "edge", "edges"), loop.length * mmPerUnit,
                            place(loop.centre, mmPerUnit));
    if (r.openLoops > r.longestLoops.size())
        list += fmt::format("; and {} shorter", r.openLoops - r.longestLoops.size());
    return list;
}

namespace {

void describeTopology(const MeshReport& r, double mmPerUnit, std::vector<std::string>& out) {
    if (r.openEdges > 0)
        out.push_back(fmt::format(
            "the surface is open: {} in {}, {:.4g} mm in all ({}); single scattering leaks there: "
            "close the holes in a mesh editor, or switch single scattering off",
            counted(r.openEdges, "open edge", "open edges"),
            counted(r.openLoops, "boundary", "boundaries"), r.openLength * mmPerUnit,
            describeHoles(r, mmPerUnit)));
    if (r.nonManifoldEdges > 0)
        out.push_back(fmt::format(
            "{} by three or more faces, the first at {}; inside and outside are not clear there: "
            "remove inner walls in a mesh editor",
            counted(r.nonManifoldEdges, "edge is shared", "edges are shared"),
            place(r.nonManifoldPlace, mmPerUnit)));
    if (r.nonOrientable > 0)
        out.push_back(fmt::format(
            "{} one-sided (like a Moebius strip), so no winding is right: cut it in a mesh editor",
            counted(r.nonOrientable, "part is", "parts are")));
    if (r.flippedFaces > 0)
        out.push_back(fmt::format(
            "{} the wrong way ({} as a whole) and turned; check that inside and outside are "
            "right, or make the normals consistent in a mesh editor",
            counted(r.flippedFaces, "face was wound", "faces were wound"),
            counted(r.flippedComponents, "part", "parts")));
}

void describeLeftOut(const MeshReport& r, std::vector<std::string>& out) {
    if (r.reader.droppedFaces > 0)
        out.push_back(fmt::format(
            "{} fewer than three different corners, so no surface, and left out; a clean-up in a "
            "mesh editor removes such faces",
            counted(r.reader.droppedFaces, "face of the file has", "faces of the file have")));
    if (r.degenerateFaces > 0)
        out.push_back(
            fmt::format("{} no area, left out here; merge close vertices in a mesh editor "
                        "if cracks show",
                        counted(r.degenerateFaces, "face has", "faces have")));
    if (r.duplicateFaces > 0)
        out.push_back(
            fmt::format("{} an earlier one, left out here; remove doubles in a mesh editor if that "
                        "is not meant",
                        counted(r.duplicateFaces, "face repeats", "faces repeat")));
    if (r.unreferencedVertices > 0)
        out.push_back(
            fmt::format("{} to no face, left out also of the size that a fit sees; if a "
                        "part is missing, export the faces as well",
                        counted(r.unreferencedVertices, "vertex belongs", "vertices belong")));
    if (r.reader.ignoredNormals)
        out.emplace_back(
            "the file has normals for some of its corners only; they are ignored and computed "
            "instead: export normals for all vertices, or none");
}

}  // namespace

MeshReport inspectMesh(const TriangleMesh& mesh) {
    MeshReport report;
    report.vertices = mesh.positions.size();
    report.faces = mesh.faces.size();
    const EdgeTable edges(mesh);
    inspectEdges(mesh, edges, report);
    inspectWinding(mesh, edges, report);
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face)
        report.degenerateFaces += isDegenerate(mesh, face) ? 1 : 0;
    const std::vector<bool> duplicate = findDuplicateFaces(mesh);
    for (FaceIndex face = 0; face < mesh.faces.size(); ++face)
        report.duplicateFaces += duplicate[face] && !isDegenerate(mesh, face) ? 1 : 0;
    report.unreferencedVertices = countUnreferenced(mesh);
    return report;
}

std::vector<std::string> describe(const MeshReport& report, double mmPerUnit) {
    std::vector<std::string> sentences;
    describeTopology(report, mmPerUnit, sentences);
    describeLeftOut(report, sentences);
    return sentences;
}

}  // namespace sss
