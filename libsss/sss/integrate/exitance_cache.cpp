#include "sss/integrate/exitance_cache.h"

#include "sss/base/error.h"
#include "sss/cloud/cache_file.h"
#include "sss/cloud/exitance_store.h"
#include "sss/integrate/scene_fingerprint.h"

#include <fmt/core.h>

namespace sss {
namespace {

constexpr std::string_view kGroups = "exgroups", kSegments = "exsegms", kSites = "exsites",
                           kValues = "exvalues", kSlopes = "exslopes";

ExitanceStore::View storeOf(const CacheFile& cache, std::uint32_t body) {
    ExitanceStore::View store{cache.section<ExitanceStore::Entry>(kGroups, body),
                              cache.section<std::uint8_t>(kSegments, body),
                              cache.section<std::uint16_t>(kSites, body),
                              cache.section<Rgb>(kValues, body),
                              {}};
    if (cache.find(kSlopes, body)) store.slopes = cache.section<ExitanceSlope>(kSlopes, body);
    return store;
}

void write(CacheWriter& writer, std::uint32_t body, const Fingerprint& made,
           const ExitanceStore::View& store) {
    writer.add<ExitanceStore::Entry>(kGroups, body, made, store.entries);
    writer.add<std::uint8_t>(kSegments, body, made, store.segments);
    writer.add<std::uint16_t>(kSites, body, made, store.siteOf);
    writer.add<Rgb>(kValues, body, made, store.values);
    if (!store.slopes.empty()) writer.add<ExitanceSlope>(kSlopes, body, made, store.slopes);
}

}  // namespace

Fingerprint exitanceFingerprint(const World& world, int body, const BodyInputs& inputs) {
    Hasher hasher;
    hasher.add(shapeFingerprint(inputs)).add(exitanceInput(world, body).value);
    return hasher.finish();
}

ExitanceCache::ExitanceCache(std::filesystem::path file, std::vector<Fingerprint> fingerprints)
    : file_(std::move(file)), fingerprints_(std::move(fingerprints)) {}

std::filesystem::path exitanceFileOf(const std::filesystem::path& cloudCache) {
    std::filesystem::path file = cloudCache;
    return file += ".exitance";
}

std::uint64_t ExitanceCache::adopt(std::span<const std::unique_ptr<BodyField>> fields) {
    std::uint64_t adopted = 0;
    if (!std::filesystem::exists(file_)) return adopted;
    const CacheFile cache = CacheFile::open(file_);
    cache.checkAll();
    for (std::uint32_t b = 0; b < fields.size(); ++b) {
        const SectionInfo* found = cache.find(kGroups, b);
        if (!fields[b] || !found || found->fingerprint != fingerprints_[b]) continue;
        const bool isWhole =
            forEachGroup(storeOf(cache, b), [&](std::uint32_t index, ExitanceGroup group) {
                adopted += fields[b]->field().adopt(index, std::move(group));
                return true;
            });
        if (!isWhole)
            throw Error(ErrorKind::BadInput, file_.string(),
                        fmt::format("the exitance of body {} does not fit together", b));
    }
    return adopted;
}

std::uint64_t ExitanceCache::load(std::span<const std::unique_ptr<BodyField>> fields,
                                  Reporter& reporter) {
    try {
        return adopt(fields);
    } catch (const Error& error) {
        reporter.warn("exitance", fmt::format("cannot be used and is made anew: {}", error.what()));
        return 0;
    }
}

void ExitanceCache::save(std::span<const std::unique_ptr<BodyField>> fields, Reporter& reporter) {
    std::uint64_t computed = 0;
    for (const auto& field : fields) computed += field ? field->counts().groups : 0;
    if (computed == 0) return;
    std::optional<CacheFile> old;
    try {
        adopt(fields);  // what others have added meanwhile
        if (std::filesystem::exists(file_)) {
            CacheFile there = CacheFile::open(file_);
            there.checkAll();
            old = std::move(there);
        }
    } catch (const Error&) {
        // Damaged: load() has said so, and it is replaced now.
    }
    try {
        CacheWriter writer(file_);
        for (std::uint32_t b = 0; b < fields.size(); ++b) {
            ExitanceStore store;
            const SectionInfo* found = old ? old->find(kGroups, b) : nullptr;
            if (fields[b]) {
                fields[b]->field().forEachGroup(
                    [&](std::uint32_t index, const ExitanceGroup& g) { store.add(index, g); });
                write(writer, b, fingerprints_[b], store.view());
            } else if (found) {
                write(writer, b, found->fingerprint, storeOf(*old, b));  // for other cameras
            }
        }
        writer.commit();
    } catch (const Error& error) {
        reporter.info("exitance", fmt::format("not kept: {}", error.what()));
    }
}

}  // namespace sss
