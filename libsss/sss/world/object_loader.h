#pragma once
#include "sss/base/hash.h"
#include "sss/base/reporter.h"
#include "sss/geom/triangle_mesh.h"
#include "sss/scene/scene.h"

#include <map>
#include <memory>
#include <string>

namespace sss {

/// A surface, cleaned.
struct LoadedMesh {
    TriangleMesh mesh;  ///< object space, mm; faces wound outward; normals as asked for
    bool closed = false;
    std::string holes;  ///< where it is open, for people; object space, mm
    /// That all of it was wound inward and has been turned: withheld from the reporter where a
    /// group may show that it is the wall of a hollow.
    std::string wasInward;
    Fingerprint content;  ///< of the mesh
};

/// An object's surface and where it stands.
struct LoadedObject {
    std::shared_ptr<const LoadedMesh> shape;
    DMat4 worldFromObject{1.0};  ///< mm, fits resolved; not singular

    const TriangleMesh& mesh() const { return shape->mesh; }
    bool closed() const { return shape->closed; }
};

/// Surfaces that the frames of an animation have in common: read, cleaned and spoken of once.
class MeshStore {
public:
    /// Forgets what was not asked for since the last call.
    void nextFrame();
    std::shared_ptr<const LoadedMesh> find(const std::string& key);
    void add(const std::string& key, std::shared_ptr<const LoadedMesh> mesh);

private:
    struct Entry {
        std::shared_ptr<const LoadedMesh> mesh;
        bool isUsed = true;
    };
    std::map<std::string, Entry> entries_;
};

/// "file:line:col" of an object, or of what is loaded as one, for errors.
std::string placeOf(const ObjectSettings& object, const Scene& scene);

/// Adds the bytes of a mesh to a content hash.
void addMesh(Hasher& hasher, const TriangleMesh& mesh);

/// Reads or makes the object's mesh, removes what cannot be used, turns faces the right way, and
/// tells the reporter of everything that a user should know about it; or takes it from `store`, if
/// there is one and it has it. Throws Error{Io, BadInput}.
LoadedObject loadObject(const ObjectSettings& object, const Scene& scene, Reporter& reporter,
                        MeshStore* store = nullptr);

}  // namespace sss
