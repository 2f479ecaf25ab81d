#include "sss/integrate/exitance_cache.h"

#include "sss/base/error.h"
#include "sss/cloud/cache_file.h"
#include "sss/cloud/exitance_store.h"
#include "sss/integrate/scene_fingerprint.h"

#include <fmt/core.h>

namespace sss {
namespace {

constexpr std::string_view kGroups = "exgroups", kSegments = "exsegms", kSites = "exsites",
                           kValues = "exvalues";

}  // namespace

Fingerprint exitanceFingerprint(const World& world, int body, const BodyInputs& inputs) {
    Hasher hasher;
    hasher.add(lightFingerprint(inputs)).add(exitanceInput(world, body).value);
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
    for (std::uint32_t b = 0; b < fields.size(); ++b) {
        const SectionInfo* found = cache.find(kGroups, b);
        if (!found || found->fingerprint != fingerprints_[b]) continue;
        const ExitanceStore::View store{cache.section<ExitanceStore::Entry>(kGroups, b),
                                        cache.section<std::uint8_t>(kSegments, b),
                                        cache.section<std::uint16_t>(kSites, b),
                                        cache.section<Rgb>(kValues, b)};
        const bool isWhole = forEachGroup(store, [&](std::uint32_t index, ExitanceGroup group) {
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
    for (const auto& field : fields) computed += field->counts().groups;
    if (computed == 0) return;
    try {
        adopt(fields);  // what others have added meanwhile
    } catch (const Error&) {
        // Damaged: load() has said so, and it is replaced now.
    }
    try {
        CacheWriter writer(file_);
        for (std::uint32_t b = 0; b < fields.size(); ++b) {
            ExitanceStore store;
            fields[b]->field().forEachGroup(
                [&](std::uint32_t index, const ExitanceGroup& group) { store.add(index, group); });
            const Fingerprint& made = fingerprints_[b];
            writer.add<ExitanceStore::Entry>(kGroups, b, made, store.entries);
            writer.add<std::uint8_t>(kSegments, b, made, store.segments);
            writer.add<std::uint16_t>(kSites, b, made, store.siteOf);
            writer.add<Rgb>(kValues, b, made, store.values);
        }
        writer.commit();
    } catch (const Error& error) {
        reporter.info("exitance", fmt::format("not kept: {}", error.what()));
    }
}

}  // namespace sss
