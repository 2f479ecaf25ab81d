#pragma once
#include "sss/geom/triangle_mesh.h"

#include <string>
#include <vector>

namespace sss {

/// What a file held, and what reading did to it.
struct ReaderReport {
    std::size_t fileVertices = 0, fileFaces = 0;
    std::size_t polygons = 0;        ///< faces with more than three corners, cut into triangles
    std::size_t droppedFaces = 0;    ///< with fewer than three different corners: no surface
    std::size_t mergedVertices = 0;  ///< of an STL: corners at the same place, made one vertex
    std::size_t splitVertices = 0;   ///< added where one position has several file normals
    bool hasFileNormals = false;
    bool ignoredNormals = false;  ///< the file has normals, but not for all corners
};

/// A connected run of open edges, most often one hole; length and place in the mesh's unit.
struct OpenLoop {
    std::size_t edges = 0;
    double length = 0;
    DVec3 centre{0};  ///< mean place, by length
};

/// What is unusual about a mesh; lengths and places in its own unit. Vertices at identical
/// positions count as one wherever faces meet.
struct MeshReport {
    std::size_t vertices = 0, faces = 0;
    std::size_t components = 0;  ///< joined by edges of exactly two faces
    std::size_t closedComponents = 0;
    bool closed = false;  ///< has faces, and none of its edges has an odd number

    std::size_t openEdges = 0;  ///< with one face
    std::size_t openLoops = 0;  ///< connected runs of them
    double openLength = 0;      ///< of all open edges
    static constexpr std::size_t kLoopsKept = 5;
    std::vector<OpenLoop> longestLoops;  ///< up to kLoopsKept of them, the longest first

    std::size_t nonManifoldEdges = 0;  ///< with three or more faces
    DVec3 nonManifoldPlace{0};         ///< the middle of the first of them
    std::size_t duplicateFaces = 0;    ///< same three positions as an earlier face
    std::size_t degenerateFaces = 0;   ///< no area; see isDegenerate
    std::size_t unreferencedVertices = 0;

    std::size_t inconsistentEdges = 0;  ///< whose two faces are wound against each other
    std::size_t flippedFaces = 0;       ///< that repairWinding would flip
    std::size_t flippedComponents = 0;  ///< that repairWinding would turn as a whole
    std::size_t nonOrientable = 0;      ///< components that no winding suits

    ReaderReport reader;  ///< filled by readMesh only
};

/// Everything but what only a reader knows. Near linear: 270,000 faces take about 0.2 s.
MeshReport inspectMesh(const TriangleMesh& mesh);

/// Where the surface is open, the longest run of edges first: "4 edges, 100 mm around (0, 0, 20)
/// mm;
/// ..."; empty if it is not.
std::string describeHoles(const MeshReport& report, double mmPerUnit);

/// Plain sentences, one for each thing that deserves a warning, each with what the user can do.
std::vector<std::string> describe(const MeshReport& report, double mmPerUnit);

}  // namespace sss
