#pragma once
#include "sss/geom/mesh_report.h"
#include "sss/geom/triangle_mesh.h"

#include <filesystem>

namespace sss {

struct MeshFile {
    TriangleMesh
        mesh;  ///< in the file's unit, as the file has it: see removeUnusable, repairWinding
    MeshReport report;  ///< of `mesh`, with what the reader found
};

inline constexpr std::size_t kMaxFaces = std::size_t{1} << 30;

/// Reads OBJ, PLY, STL or OFF, by extension in any case, through OpenMesh's readers (behind a
/// sieve, see mesh_sieve.h) but not its half-edge mesh, so that no face is lost for being
/// non-manifold.
///
/// - Positions keep the digits of the file (double), which OpenMesh's readers alone do not. STL is
/// single precision by its nature; its corners at the same place are merged.
/// - Normals are kept if every face corner has one; a vertex with several (OBJ) is split, with
///   bit-identical positions. They are made unit.
/// - Polygons are cut into triangles. Faces of fewer than three different corners are left out and
///   counted.
///
/// Throws Error with the path as `where`. Io: missing or unreadable. BadInput: unknown extension,
/// broken or truncated content (names the line, vertex or face), no faces, NaN or infinite
/// coordinates, an index out of range, more than kMaxFaces triangles. Memory stays within a small
/// multiple of the file's size whatever its header says. Thread-safe; calls are serialised where
/// OpenMesh's readers share state.
MeshFile readMesh(const std::filesystem::path& path);

}  // namespace sss
