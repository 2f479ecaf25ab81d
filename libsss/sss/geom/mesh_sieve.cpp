#include "sss/geom/mesh_sieve.h"

#include "sss/base/error.h"
#include "sss/geom/normals.h"

#include <fmt/core.h>

namespace sss {

Vec3 usableNormal(const DVec3& normal) { return Vec3(unitOrZero(normal)); }

void CoordinateCheck::add(const DVec3& p) {
    if (!isFinite(p) && bad_++ == 0) {
        firstBad_ = seen_;
        firstPosition_ = p;
    }
    ++seen_;
}

void CoordinateCheck::finish() const {
    if (bad_ == 0) return;
    throw Error(ErrorKind::BadInput, where_,
                fmt::format("vertex {} (from 0) is at ({}, {}, {}); {} of {} vertices are not "
                            "finite",
                            firstBad_, firstPosition_.x, firstPosition_.y, firstPosition_.z, bad_,
                            seen_),
                "repair the mesh in a mesh editor");
}

}  // namespace sss
