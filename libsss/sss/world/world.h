#pragma once
#include "sss/base/reporter.h"
#include "sss/geom/ray_scene.h"
#include "sss/light/light.h"
#include "sss/light/light_picker.h"
#include "sss/light/mesh_light.h"
#include "sss/light/volume_light.h"
#include "sss/scene/scene.h"
#include "sss/volume/volume_segment.h"
#include "sss/world/body.h"
#include "sss/world/camera.h"
#include "sss/world/object_loader.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sss {

/// A place on a surface that a ray has hit, in the world's space.
struct SurfaceHit {
    Vec3 position{};
    Vec3 geometricNormal{};  ///< unit, by the winding: outward on closed surfaces
    Vec3 shadingNormal{};    ///< unit, interpolated, on the same side as geometricNormal
    float step = 0;          ///< mm off the face to where a ray that leaves it starts
    float distance = 0;      ///< along the ray, mm
    int object = -1;         ///< index into Scene::objects
    int material = -1;       ///< index into Scene::materials
    int body = -1;           ///< index into World::bodies; -1 if not translucent
    FaceIndex bodyFace = 0;  ///< in Body::mesh
    FaceIndex face = 0;      ///< in the object's own mesh
    Vec2 barycentrics{};
};

/// Ray mask of a body; opaque geometry has bit 0, bodies share the other 31 in turn.
std::uint32_t bodyMask(int body);

/// A scene made ready for light transport: everything opened, placed and checked. Its space is the
/// scene's, in mm, moved by -originMm so that bodies far from the origin keep their digits. Const
/// and thread-safe once built.
class World {
public:
    /// Opens meshes and environment maps; reports sizes and mean free paths in mm, and whatever is
    /// wrong with the meshes or lies beyond diffusion. Throws Error.
    World(const Scene& scene, Reporter& reporter, MeshStore* meshes = nullptr);

    /// Looks through another camera, or with other camera noise; all else of `scene` is the same.
    void lookFrom(const Scene& scene);

    // Pass 1 has a space of its own: that of the first body, so that what lights the bodies is the
    // same to the bit however all of it moves together. Where an environment has a direction, that
    // space moves with the body but does not turn.

    /// From the scene's space, in mm.
    RigidTransform lightFromScene() const;
    DMat4 lightFromObject(std::size_t object) const;
    LightSettings lightInLightSpace(std::size_t light) const;
    /// This world in that space. Cameras do not matter there.
    std::unique_ptr<const World> inLightSpace() const;

    const Scene& scene() const { return scene_; }
    const DVec3& originMm() const { return originMm_; }
    const Camera& camera() const { return *camera_; }
    const RayScene& rays() const { return *rays_; }
    const std::vector<Body>& bodies() const { return bodies_; }
    const TranslucentMaterial& materialOf(const Body& body) const;
    const Material& material(int index) const {
        return scene_.materials[static_cast<std::size_t>(index)].material;
    }
    const std::vector<std::unique_ptr<Light>>& lights() const { return lights_; }
    const LightPicker& picker() const { return *picker_; }
    /// A light that Light::seen() can find, and the probability with which picker() picks it.
    struct VisibleLight {
        const Light* light;
        float pmf;
        bool isInfinite;
    };
    std::span<const VisibleLight> visibleLights() const { return visibleLights_; }
    /// The light that an object's faces are, if they are an emitter.
    const MeshLight* emitter(int object) const {
        return emitters_[static_cast<std::size_t>(object)];
    }
    /// Whether a ray may find light that Light::seen() does not: of surfaces and volumes.
    bool hasUnseenLight() const { return hasEmitters_ || hasVolumes(); }
    /// Its index among lights().
    std::size_t emitterIndex(int object) const {
        return emitterIndices_[static_cast<std::size_t>(object)];
    }
    /// Of the surfaces.
    const Bounds& bounds() const { return bounds_; }

    /// Participating media in space, which everything that crosses it must ask about.
    VolumeList volumes() const { return volumes_; }
    bool hasVolumes() const { return !volumes_.empty(); }
    /// What they do along a ray up to `distance`.
    VolumeSegment volumesAlong(const Ray& ray, float distance) const {
        return {volumes_, ray.origin, ray.direction, distance};
    }
    /// The light that a volume is, if it glows, and the light's index among lights().
    const VolumeLight* glow(std::size_t volume) const { return glows_[volume].light; }
    std::size_t glowIndex(std::size_t volume) const { return glows_[volume].index; }

    /// An object's triangles as they stand in the world.
    RayScene::Geometry geometry(std::size_t object) const;
    std::size_t objectCount() const { return parts_.size(); }
    /// An object's surface, in its own space.
    const LoadedMesh& mesh(std::size_t object) const { return *loaded_[object].shape; }

    /// What stands where a ray hit.
    SurfaceHit surfaceAt(const Hit& hit) const;
    /// A place of a body's surface, given on Body::mesh, as if a ray had hit it.
    SurfaceHit surfaceOf(int body, FaceIndex bodyFace, const Vec2& barycentrics) const;
    /// Where a ray that leaves a surface on the side of `normal` starts.
    static Vec3 leave(const SurfaceHit& hit, const Vec3& normal) {
        return hit.position + normal * hit.step;
    }

private:
    struct Part {  // one geometry of the ray scene: one object
        std::vector<Vec3> positions, normals;
        std::vector<UVec3> faces;
        int body = -1;
        FaceIndex firstBodyFace = 0;
    };
    World(Scene scene, std::vector<LoadedObject> loaded, Reporter& reporter);
    void chooseOrigin();
    void makeBodies(Reporter& reporter);
    void makeParts();
    void makeVolumes(Reporter& reporter);
    void makeLights();
    void makeGlows();
    void describeBody(const Body& body, Reporter& reporter) const;
    void describeShells(const std::vector<int>& group, const std::vector<int>& turned,
                        Reporter& reporter) const;
    std::string holesOf(const Body& body) const;

    Scene scene_;
    std::vector<LoadedObject> loaded_;  // by object
    DVec3 originMm_{0};
    std::vector<Body> bodies_;
    std::vector<Part> parts_;  // by object
    std::optional<RayScene> rays_;
    std::vector<std::unique_ptr<Light>> lights_;
    std::vector<VisibleLight> visibleLights_;
    std::vector<const MeshLight*> emitters_;   // by object
    std::vector<std::size_t> emitterIndices_;  // by object
    bool hasEmitters_ = false;
    std::vector<std::unique_ptr<Volume>> volumes_;
    struct Glow {
        const VolumeLight* light = nullptr;
        std::size_t index = 0;
    };
    std::vector<Glow> glows_;  // by volume
    std::optional<LightPicker> picker_;
    std::optional<Camera> camera_;
    Bounds bounds_;
};

}  // namespace sss
