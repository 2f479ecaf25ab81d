#pragma once
#include "sss/base/vec.h"

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>

namespace sss::testing {

template <typename T>
void append(std::string& bytes, T value, bool bigEndian = false) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes += raw[bigEndian ? sizeof(T) - 1 - i : i];
}

/// The corners of a tetrahedron of edge 1 at the axes, and its faces wound outward.
inline constexpr DVec3 kTetraPoints[4]{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
inline constexpr std::uint32_t kTetraFaces[4][3]{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

/// A tetrahedron as binary PLY with double coordinates, moved by `at` and scaled by `size`.
inline std::string tetraPly(bool bigEndian = false, const DVec3& at = DVec3{0}, double size = 1) {
    std::string bytes = std::string("ply\nformat binary_") + (bigEndian ? "big" : "little") +
                        "_endian 1.0\ncomment made here\nelement vertex 4\nproperty double x\n"
                        "property double y\nproperty double z\nproperty uchar red\nelement face 4\n"
                        "property list uchar int vertex_index\nend_header\n";
    for (const DVec3& p : kTetraPoints) {
        for (int axis = 0; axis < 3; ++axis) append(bytes, at[axis] + size * p[axis], bigEndian);
        append(bytes, std::uint8_t{200});
    }
    for (const auto& f : kTetraFaces) {
        append(bytes, std::uint8_t{3});
        for (std::uint32_t v : f) append(bytes, static_cast<std::int32_t>(v), bigEndian);
    }
    return bytes;
}

/// A tetrahedron as binary STL whose header starts with the word that marks ASCII files.
inline std::string tetraBinaryStl() {
    std::string bytes = "solid but binary";
    bytes.resize(80, ' ');
    append(bytes, std::uint32_t{4});
    for (const auto& f : kTetraFaces) {
        for (int i = 0; i < 3; ++i) append(bytes, 0.0f);
        for (std::uint32_t v : f)
            for (int axis = 0; axis < 3; ++axis)
                append(bytes, static_cast<float>(kTetraPoints[v][axis]));
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

}  // namespace sss::testing
