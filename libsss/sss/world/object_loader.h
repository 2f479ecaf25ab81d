#pragma once
#include "sss/base/reporter.h"
#include "sss/geom/triangle_mesh.h"
#include "sss/scene/scene.h"

namespace sss {

/// An object's surface, cleaned, and where it stands.
struct LoadedObject {
    TriangleMesh mesh;           ///< object space, mm; faces wound outward; normals as asked for
    DMat4 worldFromObject{1.0};  ///< mm, fits resolved
    bool closed = false;
};

/// Reads or makes the object's mesh, removes what cannot be used, turns faces the right way, and
/// tells the reporter of everything that a user should know about it. Throws Error{Io, BadInput}.
LoadedObject loadObject(const ObjectSettings& object, const Scene& scene, Reporter& reporter);

}  // namespace sss
