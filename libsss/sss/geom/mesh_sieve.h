#pragma once
#include "sss/base/vec.h"

#include <string>
#include <string_view>
#include <vector>

namespace sss {

/// A mesh file reduced to what OpenMesh reads correctly, and checked.
///
/// OpenMesh 9 loses things without a word: it stores coordinates as float, skips a line it cannot
/// parse (which shifts all later indices), takes colours behind an OFF face for further faces,
/// ignores an OFF file's normals, misreads or refuses many PLY lists, opens the material files that
/// an OBJ names, and trusts counts and indices. So every file passes a
/// sieve first: it checks each number, index and count against the file, keeps the coordinates in
/// double, and hands on only what concerns faces (for OBJ also its normals by corner). What comes out of OpenMesh is counted
/// against what went in.
struct SievedMesh {
    std::string bytes;             ///< for OpenMesh's reader
    bool binary = false;
    std::vector<DVec3> positions;  ///< one a vertex in the file's order; none for STL, see there
    std::vector<Vec3> normals;     ///< one a vertex, zero = missing; or empty (OBJ: see bytes)
    std::size_t faces = 0;         ///< records in the file
    std::size_t repeating = 0;     ///< faces of over three corners that use a vertex twice
};

// All throw Error{BadInput} with `where` and the line, vertex or face.

/// Keeps the lines v, vn and f; `\` continuations are joined.
SievedMesh sieveObj(std::string bytes, const std::string& where);
/// ASCII OFF, with or without header word, normals (N), colours (C) or texture coordinates (ST).
SievedMesh sieveOff(std::string_view bytes, const std::string& where);
/// ASCII and both binary forms; comes out as a plain little-endian one.
SievedMesh sievePly(std::string_view bytes, const std::string& where);
/// ASCII and binary. STL holds single precision, so positions are left to OpenMesh.
SievedMesh sieveStl(std::string bytes, const std::string& where);

/// Unit, or zero if `normal` is none: NaN, infinite or of no length.
Vec3 usableNormal(const DVec3& normal);

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
