#pragma once
#include "sss/base/vec.h"

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sss {

/// A mesh file checked, and reduced to what OpenMesh reads correctly.
///
/// OpenMesh 9 loses things without a word: it stores coordinates as float, skips a line it cannot
/// parse (which shifts all later indices), takes colours behind an OFF face for further faces,
/// ignores an OFF file's normals, keeps one of the normals of an OBJ vertex, misreads or refuses
/// many PLY lists, opens the material files that an OBJ names, and trusts counts and indices; its
/// text readers take 30 times as long as the parsing here. So every file passes a sieve first: it
/// checks each number, index and count against the file and keeps the coordinates in double.
/// OpenMesh then gets the faces in the form that it reads best, and what comes out of it is counted
/// against what went in.
struct SievedMesh {
    std::vector<DVec3> positions;        ///< one a vertex in the file's order
    std::vector<Vec3> normals;           ///< one a vertex, zero = missing; or empty
    std::vector<std::uint32_t> sizes;    ///< corners of each face
    std::vector<std::uint32_t> corners;  ///< vertices, face after face
    std::vector<Vec3> cornerNormals;     ///< one a corner, zero = missing; or empty

    /// Vertices (without their positions) and faces as binary PLY.
    std::string plainPly() const;
};

// All throw Error{BadInput} with `where` and the line, vertex or face.

/// Takes the lines v, vn and f; `\` continuations are joined.
SievedMesh sieveObj(std::string bytes, const std::string& where);
/// ASCII OFF, with or without header word, normals (N), colours (C) or texture coordinates (ST).
SievedMesh sieveOff(std::string_view bytes, const std::string& where);
/// ASCII and both binary forms.
SievedMesh sievePly(std::string_view bytes, const std::string& where);

/// STL holds loose triangles in single precision; OpenMesh merges their corners.
struct SievedStl {
    std::string bytes;  ///< binary STL
    std::size_t faces = 0;
};
SievedStl sieveStl(std::string bytes, const std::string& where);

/// Unit, or zero if `normal` is none: NaN, infinite or of no length.
Vec3 usableNormal(const DVec3& normal);

/// Appends the bytes of a number as the machine, little-endian, has them.
template <typename T>
void appendBytes(std::string& bytes, T value) {
    static_assert(std::endian::native == std::endian::little);
    const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    bytes.append(raw.data(), raw.size());
}

/// Refuses a mesh with NaN or infinite coordinates, after all have been counted.
class CoordinateCheck {
public:
    explicit CoordinateCheck(const std::string& where) : where_(where) {}
    void add(const DVec3& p);
    /// Throws if any was bad: names the first and says how many.
    void finish() const;

private:
    const std::string& where_;
    std::size_t seen_ = 0, bad_ = 0, firstBad_ = 0;
    DVec3 firstPosition_{0};
};

}  // namespace sss
