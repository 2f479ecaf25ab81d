#include "sss/integrate/cloud_cache.h"

#include "sss/base/error.h"
#include "sss/integrate/scene_fingerprint.h"

#include <fmt/core.h>

namespace sss {
namespace {

const JsonValue::Array& bodiesOf(const JsonValue& meta, const std::string& path) {
    const JsonValue& bodies = metaMember(meta, "bodies", path);
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

std::vector<BodyInputs> worldInputs(const World& world,
                                    std::span<const std::unique_ptr<BodyOptics>> optics) {
    std::vector<BodyInputs> inputs;
    for (std::size_t b = 0; b < optics.size(); ++b)
        inputs.push_back(bodyInputs(world, static_cast<int>(b), optics,
                                    pointSpacingMm(world, world.bodies()[b], *optics[b])));
    return inputs;
}

void writeCloudCache(const std::filesystem::path& path, const World& world,
                     std::span<const CachedBody> cached) {
    CacheWriter writer(path);
    JsonValue bodies = JsonValue::array();
    for (std::uint32_t b = 0; b < cached.size(); ++b) {
        addCloud(writer, b, *cached[b].inputs, cached[b].cloud);
        bodies.push(describeBody(world, static_cast<int>(b), *cached[b].report, *cached[b].inputs));
    }
    JsonValue meta = JsonValue::object();
    meta.set("program", "sss-preprocess " SSS_VERSION)
        .set("scene", world.scene().file.string())
        .set("metersPerUnit", world.scene().metersPerUnit)
        .set("seed", static_cast<double>(world.scene().quality.seed))
        .set("tolerance", world.scene().quality.tolerance)
        .set("units", "mm, mm^-1, W m^-2")
        .set("bodies", std::move(bodies));
    addMetadata(writer, meta);
    writer.commit();
}

CloudCache::CloudCache(const std::filesystem::path& path, const World& world,
                       std::span<const std::unique_ptr<BodyOptics>> optics)
    : CloudCache(path, world, optics, worldInputs(world, optics)) {}

CloudCache::CloudCache(const std::filesystem::path& path, const World& world,
                       std::span<const std::unique_ptr<BodyOptics>> optics,
                       std::span<const BodyInputs> worldInputs)
    : file_(CacheFile::open(path)) {
    const std::string where = path.string();
    const JsonValue meta = metadataOf(file_);
    const JsonValue::Array& bodies = bodiesOf(meta, where);
    if (bodies.size() != world.bodies().size())
        refuse(where, fmt::format("it holds {} translucent objects, the scene has {}",
                                  bodies.size(), world.bodies().size()));
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        const JsonValue& hashes = metaMember(bodies[b], "inputs", where);
        for (const InputFingerprint& input : worldInputs[b]) {
            const JsonMember* stored = hashes.isObject() ? hashes.find(input.key) : nullptr;
            if (!stored || !stored->value.isString() ||
                stored->value.asString() != input.value.hex())
                refuse(where, fmt::format("for object \"{}\", {}", world.bodies()[b].name,
                                          input.sentence));
        }
        const BodyReport& report = reports_.emplace_back(reportOf(bodies[b], where));
        BodyCloud::View& view = views_.emplace_back(cloudOf(file_, b, report.spacingMm));
        if (!optics[b]->onShape) continue;
        view.solved = solvedOf(file_, b, view.cloud.points.size());
        optics[b]->lookThroughIf(report.unscatteredShare, world.scene().quality.tolerance);
    }
}

JsonValue describeCache(const std::filesystem::path& path) {
    const CacheFile file = CacheFile::open(path);
    file.checkAll();
    JsonValue meta = metadataOf(file);
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
