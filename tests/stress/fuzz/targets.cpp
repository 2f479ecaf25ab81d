#include "fuzz/targets.h"

#include "fuzz/input_file.h"
#include "fuzz/repair.h"
#include "sss/base/error.h"
#include "sss/base/reporter.h"
#include "sss/cloud/cache_file.h"
#include "sss/cloud/diffusion_sum.h"
#include "sss/cloud/exitance_store.h"
#include "sss/geom/mesh_io.h"
#include "sss/geom/mesh_repair.h"
#include "sss/image/exr_file.h"
#include "sss/integrate/body_cloud.h"
#include "sss/integrate/cloud_cache.h"
#include "sss/integrate/preprocess.h"
#include "sss/light/environment_light.h"
#include "sss/scene/scene_reader.h"

#include <algorithm>
#include <cmath>

namespace sss::stress {
namespace {

/// Runs a reader; false if it has refused its input as it should.
template <typename Reader>
bool accepts(const Reader& reader) {
    try {
        reader();
        return true;
    } catch (const Error& error) {
        const bool isTheInputs =
            error.kind() == ErrorKind::BadInput || error.kind() == ErrorKind::Resource;
        if (!isTheInputs) fail(error.what());
        if (error.where().empty()) fail("an error that does not say where");
        return false;
    }
}

void readSceneBytes(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    accepts([&] {
        const JsonValue value = parseJson(text, "input.json");
        // What was read can be written, and is the same when read again.
        const std::string written = dump(value);
        if (dump(parseJson(written, "again.json")) != written) fail("JSON changes when read again");
    });
    accepts([&] {
        const Scene scene = readSceneText(text, "input.json");
        if (scene.objects.empty() && scene.volumes.empty()) fail("a scene without anything");
        for (const ObjectSettings& object : scene.objects)
            if (object.material < 0 ||
                static_cast<std::size_t>(object.material) >= scene.materials.size())
                fail("an object without a material");
    });
}

void checkMesh(const TriangleMesh& mesh) {
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        fail("normals do not match the vertices");
    for (const UVec3& face : mesh.faces)
        for (int c = 0; c < 3; ++c)
            if (face[c] >= mesh.positions.size()) fail("a face without its vertex");
    for (const DVec3& p : mesh.positions)
        if (!isFinite(p)) fail("a vertex that is not finite");
    for (const Vec3& n : mesh.normals)
        if (!(std::abs(glm::length(n) - 1) < 1e-3f) && !isZero(n)) fail("a normal not of length 1");
}

template <const char* Extension>
void readMeshBytes(std::span<const std::byte> input) {
    const std::filesystem::path& path = inputFile(Extension, input);
    accepts([&] {
        MeshFile file = readMesh(path);
        if (file.mesh.faces.empty()) fail("a mesh without faces");
        checkMesh(file.mesh);
        describe(file.report, 1.0);
        removeUnusable(file.mesh);
        repairWinding(file.mesh);
        checkMesh(file.mesh);
        for (FaceIndex face = 0; face < file.mesh.faceCount(); ++face)
            if (isDegenerate(file.mesh, face)) fail("a face without area has stayed");
    });
}

void readExrBytes(std::span<const std::byte> input) {
    const std::filesystem::path& path = inputFile("exr", input);
    accepts([&] {
        const LayeredImage image = readExr(path);
        for (const ImageLayer& layer : image.layers)
            if (layer.values.size() != image.pixelCount() * layer.channels.size())
                fail("a layer of the wrong size");
    });
    // As the light of a scene, with what is made of it to be sampled.
    accepts([&] {
        EnvironmentLight settings;
        settings.map = path;
        const std::unique_ptr<Light> light = makeEnvironment(settings);
        for (const Vec2& u : {Vec2(0.0f), Vec2(0.3f, 0.7f), Vec2(0.999f)}) {
            const LightSample sample = light->sample(Vec3(0.0f), u);
            if (!isFinite(sample.direction) || !isFinite(sample.radiance))
                fail("a sample of the sky that is not finite");
        }
        const Rgb seen = light->seen(Vec3(0.0f), Vec3(0, 0, 1)).radiance;
        if (!isFinite(seen) || minComponent(seen) < 0) fail("a sky that is not finite or negative");
    });
}

/// The scene that tests/stress/corpus/cache was made for; see its README.
const char* const kScene = R"({
  "metersPerUnit": 0.001, "camera": {"position": [0, 0, 30], "lookAt": [0, 0, 0]},
  "quality": {"spacingMm": 3, "tolerance": 0.1},
  "materials": {"stone": {"type": "translucent", "medium": "Marble"}},
  "objects": [{"shape": "box", "size": [4, 4, 4], "material": "stone"}],
  "lights": [{"type": "environment", "radiance": 1}]})";

struct CacheScene {
    SilentReporter silent;
    World world{readSceneText(kScene, "scene.json"), silent};
    std::vector<std::unique_ptr<BodyOptics>> optics = makeBodyOptics(world);
    std::vector<BodyInputs> inputs = worldInputs(world, optics);
    KernelTable table{optics.front()->profilePointers(), 10.0, 1.0};
};

void readCacheBytes(std::span<const std::byte> input) {
    static const CacheScene scene;
    const auto readIt = [&](std::span<const std::byte> bytes) {
        const std::filesystem::path& path = inputFile("ssc", bytes);
        accepts([&] { describeCache(path); });
        accepts([&] {
            const CloudCache cache(path, scene.world, scene.optics, scene.inputs);
            const BodyCloud::View view = cache.view(0);
            const DiffusionSum sum(view.cloud, view.nodes, scene.table);
            DiffusionSum::Scratch scratch;
            SumCounts counts;
            const std::array<Vec3, 2> receivers{Vec3(2, 0, 0), Vec3(2, 0.5f, 0)};
            std::array<Rgb, 2> out;
            sum.evaluate(receivers, 0.1, out, scratch, counts);
        });
    };
    readIt(input);
    readIt(withRightChecksums(input));  // as a faulty or hostile writer would leave it
}

void readExitanceBytes(std::span<const std::byte> input) {
    const std::filesystem::path& path = inputFile("exitance", withRightChecksums(input));
    accepts([&] {
        const CacheFile cache = CacheFile::open(path);
        const ExitanceStore::View store{cache.section<ExitanceStore::Entry>("exgroups", 0),
                                        cache.section<std::uint8_t>("exsegms", 0),
                                        cache.section<std::uint16_t>("exsites", 0),
                                        cache.section<Rgb>("exvalues", 0)};
        forEachGroup(store, [](std::uint32_t, ExitanceGroup group) {
            for (std::uint32_t patch = 0; patch < group.segments.size(); ++patch)
                if (!isFinite(group.at(patch, {0.3f, 0.3f}))) fail("exitance that is not finite");
            return true;
        });
    });
}

constexpr char kObj[] = "obj", kPly[] = "ply", kOff[] = "off", kStl[] = "stl";
constexpr FuzzTarget kTargets[] = {
    {"scene", readSceneBytes},    {"cache", readCacheBytes},    {"exitance", readExitanceBytes},
    {"obj", readMeshBytes<kObj>}, {"ply", readMeshBytes<kPly>}, {"off", readMeshBytes<kOff>},
    {"stl", readMeshBytes<kStl>}, {"exr", readExrBytes},
};

}  // namespace

std::span<const FuzzTarget> fuzzTargets() { return kTargets; }

const FuzzTarget* findFuzzTarget(std::string_view name) {
    const auto* const found = std::ranges::find(kTargets, name, &FuzzTarget::name);
    return found == std::end(kTargets) ? nullptr : found;
}

}  // namespace sss::stress
