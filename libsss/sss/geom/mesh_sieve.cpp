#include "sss/geom/mesh_sieve.h"

#include "sss/base/error.h"
#include "sss/geom/normals.h"

#include <fmt/core.h>

namespace sss {

Vec3 usableNormal(const DVec3& normal) { return Vec3(unitOrZero(normal)); }

std::string SievedMesh::plainPly() const {
    // Of the types for a list's length, OpenMesh takes uchar and int only.
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nelement face {}\n"
        "property list int uint vertex_indices\nend_header\n",
        positions.size(), sizes.size());
    const std::size_t vertexBytes = positions.size() * 3 * sizeof(float);
    bytes.reserve(bytes.size() + vertexBytes + 4 * (sizes.size() + corners.size()));
    bytes.append(vertexBytes, '\0');
    auto corner = corners.begin();
    for (std::uint32_t size : sizes) {
        appendBytes(bytes, size);
        for (std::uint32_t i = 0; i < size; ++i) appendBytes(bytes, *corner++);
    }
    return bytes;
}

void CoordinateCheck::add(const DVec3& p) {
    if (!isFinite(p) && bad_++ == 0) {
        firstBad_ = seen_;
        firstPosition_ = p;
    }
    ++seen_;
}

void CoordinateCheck::finish() const {
    if (bad_ == 0) return;
    throw Error(
        ErrorKind::BadInput, where_,
        fmt::format("vertex {} (from 0) is at ({}, {}, {}); {} of {} vertices are not "
                    "finite",
                    firstBad_, firstPosition_.x, firstPosition_.y, firstPosition_.z, bad_, seen_),
        "repair the mesh in a mesh editor");
}

}  // namespace sss
