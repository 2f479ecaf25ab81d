#include "sss/integrate/cloud_cache.h"

#include "sss/base/error.h"
#include "sss/cloud/octree_check.h"
#include "sss/integrate/scene_fingerprint.h"

#include <fmt/core.h>

namespace sss {
namespace {

constexpr std::string_view kPoints = "points", kIrradiance = "irrad", kOctree = "octree",
                           kShape = "shape", kMeta = "meta";
constexpr const char* kUnscattered = "unscatteredShare";

JsonValue list(const DRgb& v) {
    JsonValue array = JsonValue::array();
    for (int c = 0; c < 3; ++c) array.push(v[c]);
    return array;
}

JsonValue describeBody(const World& world, int index, const BodyReport& report,
                       const std::vector<InputFingerprint>& inputs) {
    const Body& body = world.bodies()[static_cast<std::size_t>(index)];
    const TranslucentMaterial& material = world.materialOf(body);
    JsonValue hashes = JsonValue::object();
    for (const InputFingerprint& input : inputs) hashes.set(input.key, input.value.hex());
    JsonValue json = JsonValue::object();
    json.set("name", body.name)
        .set("points", report.points)
        .set("nodes", report.nodes)
        .set("areaMm2", report.areaMm2)
        .set("spacingMm", report.spacingMm)
        .set("meanFreePathMm", list(material.medium.meanFreePathMm()))
        .set("sigmaAPerMm", list(material.medium.sigmaA))
        .set("sigmaSPerMm", list(material.medium.sigmaS))
        .set("g", list(material.medium.g))
        .set("eta", material.medium.eta)
        .set("expectedQuadratureError", report.expectedQuadratureError)
        .set("irradianceSamples", report.irradianceSamples)
        .set("irradianceNoise", report.irradianceNoise)
        .set("inputs", std::move(hashes));
    if (report.shape) json.set(kUnscattered, maxComponent(report.shape->unscattered));
    return json;
}

const JsonValue& member(const JsonValue& object, std::string_view key, const std::string& path) {
    const JsonMember* found = object.isObject() ? object.find(key) : nullptr;
    if (!found)
        throw Error(ErrorKind::BadInput, path, fmt::format("its metadata has no \"{}\"", key),
                    "run sss-preprocess again");
    return found->value;
}

const JsonValue::Array& bodiesOf(const JsonValue& meta, const std::string& path) {
    const JsonValue& bodies = member(meta, "bodies", path);
    if (!bodies.isArray())
        throw Error(ErrorKind::BadInput, path, "its metadata lists no bodies",
                    "run sss-preprocess again");
    return bodies.items();
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
    throw Error(ErrorKind::BadInput, path, "this cache was made for another scene: " + why,
                "run sss-preprocess on this scene again, or leave out --cache");
}

}  // namespace

void writeCloudCache(const std::filesystem::path& path, const World& world,
                     std::span<const BodyCloud> clouds, std::span<const BodyReport> reports,
                     std::span<const std::unique_ptr<BodyOptics>> optics) {
    CacheWriter writer(path);
    JsonValue bodies = JsonValue::array();
    for (std::uint32_t b = 0; b < clouds.size(); ++b) {
        const int index = static_cast<int>(b);
        const auto inputs =
            bodyInputs(world, index, pointSpacingMm(world, world.bodies()[b], *optics[b]));
        const Fingerprint points = combined(inputs, {"mesh", "sampling"});
        const Fingerprint light = combined(inputs, {"mesh", "sampling", "medium", "lights",
                                                    "volumes", "surroundings", "irradiance"});
        writer.add<SurfacePoint>(kPoints, b, points, clouds[b].points);
        writer.add<Rgb>(kIrradiance, b, light, clouds[b].irradiance);
        writer.add<OctreeNode>(kOctree, b, light, clouds[b].nodes);
        if (!clouds[b].correction.empty())
            writer.add<Rgb>(kShape, b, combined(inputs), clouds[b].correction);
        bodies.push(describeBody(world, index, reports[b], inputs));
    }
    JsonValue meta = JsonValue::object();
    meta.set("program", "sss-preprocess " SSS_VERSION)
        .set("scene", world.scene().file.string())
        .set("metersPerUnit", world.scene().metersPerUnit)
        .set("seed", static_cast<double>(world.scene().quality.seed))
        .set("tolerance", world.scene().quality.tolerance)
        .set("units", "mm, mm^-1, W m^-2")
        .set("bodies", std::move(bodies));
    writer.addText(kMeta, 0, {}, dump(meta, 2));
    writer.commit();
}

CloudCache::CloudCache(const std::filesystem::path& path, const World& world,
                       std::span<const std::unique_ptr<BodyOptics>> optics)
    : file_(CacheFile::open(path)) {
    const std::string where = path.string();
    const JsonValue meta = parseJson(file_.text(kMeta, 0), where);
    const JsonValue::Array& bodies = bodiesOf(meta, where);
    if (bodies.size() != world.bodies().size())
        refuse(where, fmt::format("it holds {} translucent objects, the scene has {}",
                                  bodies.size(), world.bodies().size()));
    Hasher all;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        const Body& body = world.bodies()[b];
        const JsonValue& hashes = member(bodies[b], "inputs", where);
        const auto inputs =
            bodyInputs(world, static_cast<int>(b), pointSpacingMm(world, body, *optics[b]));
        for (const InputFingerprint& input : inputs) {
            const JsonMember* stored = hashes.isObject() ? hashes.find(input.key) : nullptr;
            if (!stored || !stored->value.isString() ||
                stored->value.asString() != input.value.hex())
                refuse(where, fmt::format("for object \"{}\", {}", body.name, input.sentence));
            all.add(input.value);
        }
        const JsonValue& spacing = member(bodies[b], "spacingMm", where);
        spacingMm_.push_back(spacing.isNumber() ? spacing.asNumber() : 0.0);
        wantsShape_.push_back(optics[b]->onShape);
        if (optics[b]->onShape) {
            const JsonValue& share = member(bodies[b], kUnscattered, where);
            optics[b]->lookThroughIf(share.isNumber() ? share.asNumber() : 1.0,
                                     world.scene().quality.tolerance);
        }
        checkNodes(b);
    }
    fingerprint_ = all.finish().hex();
}

// The checksums hold; this keeps a file that some other program wrote from sending us out of
// bounds.
void CloudCache::checkNodes(std::uint32_t body) const {
    const CloudView cloud{file_.section<SurfacePoint>(kPoints, body),
                          file_.section<Rgb>(kIrradiance, body)};
    const bool shapeFits =
        !file_.find(kShape, body) || file_.section<Rgb>(kShape, body).size() == cloud.points.size();
    if (!shapeFits || !isSound(cloud, file_.section<OctreeNode>(kOctree, body)))
        throw Error(ErrorKind::BadInput, file_.path().string(),
                    fmt::format("the octree of body {} does not fit its points", body),
                    "run sss-preprocess again");
}

BodyCloud::View CloudCache::view(std::size_t body) const {
    const auto b = static_cast<std::uint32_t>(body);
    return {{file_.section<SurfacePoint>(kPoints, b), file_.section<Rgb>(kIrradiance, b)},
            file_.section<OctreeNode>(kOctree, b),
            spacingMm_[body],
            wantsShape_[body] ? file_.section<Rgb>(kShape, b) : std::span<const Rgb>()};
}

JsonValue describeCache(const std::filesystem::path& path) {
    const CacheFile file = CacheFile::open(path);
    JsonValue meta = parseJson(file.text(kMeta, 0), path.string());
    JsonValue description = JsonValue::object();
    description.set("file", path.string())
        .set("format", kCacheVersion)
        .set("bytes", file.fileBytes());
    if (meta.isObject())
        for (const JsonMember& m : meta.members()) description.set(m.key, m.value);
    JsonValue sections = JsonValue::array();
    for (const SectionInfo& section : file.sections()) {
        JsonValue entry = JsonValue::object();
        entry.set("kind", section.kind)
            .set("body", section.body)
            .set("count", section.count)
            .set("bytes", section.bytes)
            .set("fingerprint", section.fingerprint.hex());
        sections.push(std::move(entry));
    }
    description.set("sections", std::move(sections));
    return description;
}

}  // namespace sss
