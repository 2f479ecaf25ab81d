#pragma once
#include "sss/geom/rigid.h"
#include "sss/geom/triangle_mesh.h"
#include "sss/scene/scene.h"
#include "sss/world/object_loader.h"

#include <span>
#include <string>
#include <vector>

namespace sss {

/// A translucent body: one object, or all objects of one group, as one surface with one inside. Its
/// mesh lies in its own space, in mm, centred on its bounds, and moves rigidly with it, so that
/// points placed on it stay what they are however the body moves.
struct Body {
    std::string name;                  ///< of the group, or of the object
    int material = 0;                  ///< index into Scene::materials; a TranslucentMaterial
    TriangleMesh mesh;                 ///< body space, mm; normals for all vertices or for none
    RigidTransform worldFromBody;      ///< to the world's recentred space, mm
    bool closed = false;               ///< all its objects are
    std::vector<int> objects;          ///< indices into Scene::objects
    std::vector<FaceIndex> firstFace;  ///< of each object, in `mesh`

    /// Shading normal (unit, body space) at a place: interpolated, or the face's own.
    Vec3 normalAt(FaceIndex face, const Vec2& barycentrics) const;
};

/// Joins the loaded objects `members` (indices into both spans) into a body.
Body joinBody(std::string name, std::span<const int> members, std::span<const LoadedObject> loaded,
              const Scene& scene, const DVec3& originMm);

/// `mesh` moved by an affine map; faces turn if the map mirrors, normals by the inverse transpose.
TriangleMesh transformedMesh(const TriangleMesh& mesh, const DMat3& linear, const DVec3& offset);

}  // namespace sss
