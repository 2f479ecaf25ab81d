#pragma once
#include "sss/geom/mesh_report.h"
#include "sss/geom/triangle_mesh.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sss {

/// Vertices, normals and polygons as a reader delivers them one after the other, until they are all
/// there and become a TriangleMesh.
class FaceCollector {
public:
    std::uint32_t addVertex(const Vec3& position);
    void setPosition(std::uint32_t vertex, const Vec3& position);
    /// The normal of a vertex in the next face.
    void setCornerNormal(std::uint32_t vertex, const Vec3& normal);
    void addFace(std::span<const std::uint32_t> corners);

    std::size_t vertexCount() const { return positions_.size(); }
    std::size_t faceCount() const { return faceEnds_.size(); }

    /// Positions and normals by vertex that replace the delivered ones; empty = none.
    struct Exact {
        std::vector<DVec3> positions;
        std::vector<Vec3> normals;
    };
    /// The triangles. Fills `report`. Throws Error{BadInput} with `where`.
    TriangleMesh build(Exact exact, ReaderReport& report, const std::string& where);

private:
    struct CornerNormal {
        std::uint32_t vertex;
        Vec3 normal;
    };
    void storeCornerNormals(std::span<const std::uint32_t> corners);
    void checkRange(const std::string& where) const;
    bool hasAllCornerNormals(ReaderReport& report);
    bool coversAllCorners(const std::vector<Vec3>& vertexNormals) const;
    void splitByNormal(TriangleMesh& mesh);

    std::vector<Vec3> positions_;
    std::vector<CornerNormal> pending_;    ///< of the next face
    std::vector<Vec3> cornerNormals_;      ///< by corner; zero = none; empty if there is none at all
    std::vector<std::uint32_t> corners_;
    std::vector<std::size_t> faceEnds_;    ///< into corners_
};

}  // namespace sss
