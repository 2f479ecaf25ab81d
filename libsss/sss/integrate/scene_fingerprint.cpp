#include "sss/integrate/scene_fingerprint.h"

#include "sss/base/error.h"
#include "sss/integrate/interreflection.h"
#include "sss/integrate/irradiance.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace sss {
namespace {

// Raised when the algorithms of pass 1 change what they make of the same input.
constexpr std::uint64_t kPassOneVersion = 4;
constexpr std::uint64_t kExitanceVersion = 4;  // the same of the diffusion sum and its sites
constexpr std::uint64_t kShapeVersion = 4;     // ... and of diffusion on the shape

void add(Hasher& h, const DVec3& v) { h.add(v.x).add(v.y).add(v.z); }
void add(Hasher& h, const Rgb& v) { add(h, DVec3(v)); }

void add(Hasher& h, const DMat4& m) {
    for (int c = 0; c < 4; ++c) add(h, DVec3(m[c]));
}

void addFile(Hasher& h, const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    h.add(bytes);
}

// One overload a kind, as in light_table.cpp.
struct LightHasher {
    Hasher& h;
    void operator()(const PointLight& l) const {
        h.add("point");
        add(h, l.position);
        add(h, l.intensity);
    }
    void operator()(const SpotLight& l) const {
        h.add("spot");
        add(h, l.position);
        add(h, l.lookAt);
        add(h, l.intensity);
        h.add(l.coneDegrees).add(l.penumbraDegrees);
    }
    void operator()(const DirectionalLight& l) const {
        h.add("directional");
        add(h, l.direction);
        add(h, l.irradiance);
    }
    void operator()(const RectangleLight& l) const {
        h.add("rectangle");
        add(h, l.centre);
        add(h, l.lookAt);
        add(h, l.up);
        add(h, l.radiance);
        h.add(l.widthMm).add(l.heightMm).add(std::uint64_t{l.twoSided});
    }
    void operator()(const SphereLight& l) const {
        h.add("sphere");
        add(h, l.centre);
        add(h, l.radiance);
        h.add(l.radiusMm);
    }
    void operator()(const EnvironmentLight& l) const {
        h.add("environment");
        add(h, l.radiance);
        h.add(l.rotationDegrees);
        if (!l.map.empty()) addFile(h, l.map);
    }
};

// The medium and its profile.
void addDiffusion(Hasher& h, const TranslucentMaterial& m) {
    add(h, m.medium.sigmaA);
    add(h, m.medium.sigmaS);
    add(h, m.medium.g);
    h.add(m.medium.eta).add(m.profile);
    h.add(static_cast<std::uint64_t>(m.profileOptions.boundary));
    h.add(m.profileOptions.slabThicknessMm.value_or(-1.0));
    h.add(m.profileOptions.surfaceAlbedo.value_or(-1.0));
}

struct MaterialHasher {
    Hasher& h;
    void operator()(const TranslucentMaterial& m) const {
        h.add("translucent");
        addDiffusion(h, m);
        h.add(m.roughness).add(static_cast<std::uint64_t>(m.energy));
        h.add(std::uint64_t{m.surfaceReflection}).add(std::uint64_t{m.singleScattering});
        h.add(std::uint64_t{m.multipleScattering});
        add(h, m.diffuseColor.value_or(DRgb(-1)));
    }
    void operator()(const LambertianMaterial& m) const {
        h.add("lambertian");
        add(h, m.reflectance);
    }
    void operator()(const MetalMaterial& m) const {
        h.add("metal");
        add(h, m.eta);
        add(h, m.k);
        h.add(m.roughness);
    }
    void operator()(const EmitterMaterial& m) const {
        h.add("emitter");
        add(h, m.radiance);
        h.add(std::uint64_t{m.twoSided});
    }
};

Fingerprint volumesOf(const World& world) {
    Hasher h;
    if (world.hasVolumes()) {  // they are not cut free of rounding: where they stand counts, too
        add(h, world.originMm());
        const RigidTransform place = world.lightFromScene();
        for (int c = 0; c < 3; ++c) add(h, place.rotation[c]);
        add(h, place.translation);
    }
    for (std::size_t v = 0; v < world.volumes().size(); ++v) {
        const VolumeSettings& settings = world.scene().volumes[v];
        // Where its cube stands, and what part of it.
        for (const DVec3& corner : {DVec3(0), DVec3(1, 0, 0), DVec3(0, 1, 0), DVec3(0, 0, 1)})
            add(h, world.volumes()[v]->worldFromUnit(corner));
        h.add(static_cast<std::uint64_t>(settings.shape.index()));
        if (const auto* mesh = std::get_if<MeshFileShape>(&settings.shape)) addFile(h, mesh->path);
        add(h, settings.sigmaA);
        add(h, settings.sigmaS);
        add(h, settings.emission);
        h.add(settings.g);
        if (!settings.grid) continue;
        for (const int n :
             {settings.grid->nx, settings.grid->ny, settings.grid->nz, settings.grid->channels})
            h.add(static_cast<std::uint64_t>(n));
        addFile(h, settings.grid->path);
    }
    return h.finish();
}

Fingerprint lightsOf(const World& world) {
    Hasher h;
    for (std::size_t k = 0; k < world.scene().lights.size(); ++k)
        std::visit(LightHasher{h}, world.lightInLightSpace(k));
    return h.finish();
}

using Optics = std::span<const std::unique_ptr<BodyOptics>>;

// A body in its diffuse limit (Bsdf::BodyShading): all that pass 1 reads of a medium.
void addDiffuseLimit(Hasher& h, const BodyOptics& optics) {
    h.add("diffuse limit").add(optics.material.medium.eta);
    add(h, optics.diffuseAlbedo);
}

const BodyOptics& opticsOf(const World& world, int object, Optics optics) {
    std::size_t b = 0;
    while (std::ranges::find(world.bodies()[b].objects, object) == world.bodies()[b].objects.end())
        ++b;
    return *optics[b];
}

// What an object does to light that comes from it to a body: that of emitters always, that of the
// others if light is followed from surface to surface.
void addReflection(Hasher& h, const World& world, std::size_t object, Optics optics) {
    const Material& material = world.material(world.scene().objects[object].material);
    if (!std::holds_alternative<EmitterMaterial>(material) && world.scene().quality.bounces == 0)
        return;
    if (std::holds_alternative<TranslucentMaterial>(material))
        addDiffuseLimit(h, opticsOf(world, static_cast<int>(object), optics));
    else
        std::visit(MaterialHasher{h}, material);
}

Fingerprint mediumOf(const World& world, int body, const BodyOptics& optics) {
    Hasher h;
    h.add(optics.material.medium.eta);
    if (mayComeBack(world, body)) addDiffuseLimit(h, optics);
    return h.finish();
}

// What diffusion on the shape depends on beside the light, which has eta (and so the beams) in it.
Fingerprint shapeOf(const TranslucentMaterial& material, double tolerance) {
    Hasher h;
    h.add(kShapeVersion).add(tolerance);
    addDiffusion(h, material);
    h.add(std::uint64_t{material.singleScattering});
    return h.finish();
}

// All objects, where they stand relative to the first body, and what the others are made of. The
// body itself counts with its place only: its mesh and medium are inputs of their own.
Fingerprint surroundingsOf(const World& world, int body, Optics optics) {
    Hasher h;
    const Body& own = world.bodies()[static_cast<std::size_t>(body)];
    for (std::size_t k = 0; k < world.scene().objects.size(); ++k) {
        add(h, world.lightFromObject(k));
        const bool isOwn = std::ranges::find(own.objects, static_cast<int>(k)) != own.objects.end();
        h.add(std::uint64_t{isOwn});
        if (isOwn) continue;
        h.add(world.mesh(k).content);
        addReflection(h, world, k, optics);
    }
    return h.finish();
}

}  // namespace

BodyInputs bodyInputs(const World& world, int bodyIndex, Optics optics, double spacingMm,
                      const TriangleMesh* placedOn) {
    const Body& body = world.bodies()[static_cast<std::size_t>(bodyIndex)];
    const QualitySettings& quality = world.scene().quality;
    BodyInputs inputs;
    Hasher mesh, form, sampling, light;
    addMesh(mesh, placedOn != nullptr ? *placedOn : body.mesh);
    inputs.push_back({"mesh", "the mesh (or its scale) is another", mesh.finish()});
    sampling.add(kPassOneVersion).add(spacingMm).add(quality.seed);
    inputs.push_back({"sampling",
                      "its points differ: in seed, or in spacing, by tolerance or medium",
                      sampling.finish()});
    addMesh(form, body.mesh);
    inputs.push_back({"form", "it has another shape", form.finish()});
    inputs.push_back({"medium", "its medium refracts or reflects otherwise",
                      mediumOf(world, bodyIndex, *optics[static_cast<std::size_t>(bodyIndex)])});
    inputs.push_back(
        {"lights", "the lights are others, or stand elsewhere around it", lightsOf(world)});
    inputs.push_back({"volumes", "the volumes in space are others", volumesOf(world)});
    inputs.push_back({"surroundings", "it stands elsewhere, or other objects of the scene differ",
                      surroundingsOf(world, bodyIndex, optics)});
    light.add(static_cast<std::uint64_t>(irradianceSamplesFor(quality)))
        .add(static_cast<std::uint64_t>(quality.bounces));
    inputs.push_back(
        {"irradiance", "irradiance samples or bounces of the light pass differ", light.finish()});
    const TranslucentMaterial& material = world.materialOf(body);
    if (material.onShape && body.closed)
        inputs.push_back({"shape",
                          "it was made for another medium, model of diffusion or tolerance",
                          shapeOf(material, quality.tolerance)});
    return inputs;
}

InputFingerprint exitanceInput(const World& world, int body) {
    Hasher h;
    h.add(kExitanceVersion).add(world.scene().quality.tolerance);
    MaterialHasher{h}(world.materialOf(world.bodies()[static_cast<std::size_t>(body)]));
    return {"exitance", "the medium, its profile or the tolerance are others", h.finish()};
}

std::vector<std::string_view> pointsKeys() { return {"mesh", "sampling"}; }

std::vector<std::string_view> lightKeys() {
    return {"mesh",   "sampling", "form",         "medium",
            "lights", "volumes",  "surroundings", "irradiance"};
}

Fingerprint pointsFingerprint(const BodyInputs& inputs) { return combined(inputs, pointsKeys()); }

Fingerprint lightFingerprint(const BodyInputs& inputs) { return combined(inputs, lightKeys()); }

Fingerprint shapeFingerprint(const BodyInputs& inputs) {
    Hasher h;
    for (const InputFingerprint& input : inputs) h.add(input.value);
    return h.finish();
}

Fingerprint combined(const BodyInputs& inputs, const std::vector<std::string_view>& keys) {
    Hasher h;
    for (const InputFingerprint& input : inputs)
        if (std::find(keys.begin(), keys.end(), input.key) != keys.end()) h.add(input.value);
    return h.finish();
}

}  // namespace sss
