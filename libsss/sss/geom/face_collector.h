#pragma once
#include "sss/geom/mesh_report.h"
#include "sss/geom/mesh_sieve.h"
#include "sss/geom/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sss {

/// Vertices and polygons as a reader delivers them one after the other, until they are all there
/// and become a TriangleMesh.
class FaceCollector {
public:
    std::uint32_t addVertex(const Vec3& position);
    void setPosition(std::uint32_t vertex, const Vec3& position);
    void addFace(std::span<const std::uint32_t> corners);

    std::size_t vertexCount() const { return positions_.size(); }
    std::size_t faceCount() const { return faceEnds_.size(); }
    std::size_t cornerCount() const { return corners_.size(); }

    /// The triangles, with the positions and normals of the sieve if there was one (else null).
    /// Fills `report`. Throws Error{BadInput} with `where`, also for more than `mostFaces`
    /// triangles.
    TriangleMesh build(SievedMesh* exact, ReaderReport& report, const std::string& where,
                       std::size_t mostFaces);

private:
    void checkRange(const std::string& where, std::size_t mostFaces) const;
    void takeNormals(SievedMesh& exact, TriangleMesh& mesh, ReaderReport& report);
    void splitByNormal(const std::vector<Vec3>& cornerNormals, TriangleMesh& mesh);

    std::vector<Vec3> positions_;
    std::vector<std::uint32_t> corners_;
    std::vector<std::size_t> faceEnds_;  ///< into corners_
};

}  // namespace sss
