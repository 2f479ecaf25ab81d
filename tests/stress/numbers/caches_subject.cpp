#include "fuzz/repair.h"
#include "numbers/damage.h"
#include "numbers/passes.h"
#include "numbers/subjects.h"
#include "sss/base/error.h"
#include "sss/cloud/cache_format.h"
#include "sss/integrate/cloud_cache.h"
#include "sss/integrate/exitance_cache.h"
#include "support/temporary_folder.h"
#include "unit/integrate/cache_maker.h"

#include <fmt/format.h>

#include <chrono>
#include <cstring>

namespace sss::stress {
namespace {

using testing::readFile;
using testing::TemporaryFolder;
using testing::writeFile;

// Whether opening it and looking at all of it ends in an error that names the file and says what is
// wrong.
bool isRefused(const std::filesystem::path& file, const Passes& passes) {
    try {
        const CloudCache cache(file, passes.world(), passes.optics());
        cache.view(0).cloud.needAll();
        return false;
    } catch (const Error& error) {
        return error.kind() == ErrorKind::BadInput &&
               error.where().find(file.filename().string()) != std::string::npos;
    }
}

void damagedClouds(const TemporaryFolder& folder, const Passes& passes, Report& report) {
    Row row("caches", "cache cut or flipped: refused by name", 0);
    const std::string whole = readFile(folder / "good.ssc");
    forEachDamage(whole, [&](const std::string& bytes, const std::string& what) {
        writeFile(folder / "bad.ssc", bytes);
        row.expect(isRefused(folder / "bad.ssc", passes), [&] { return what; });
    });
    report.add(row);
}

// A header or table that promises what no file can hold, with right checksums.
void bombs(const TemporaryFolder& folder, const Passes& passes, Report& report) {
    Row row("caches", "counts of 2^63 in header or table: refused", 0);
    Row seconds("caches", "... within so many seconds", 1);
    const std::string whole = readFile(folder / "good.ssc");
    CacheHeader header;
    std::memcpy(&header, whole.data(), sizeof header);
    const auto tryIt = [&](std::size_t place, std::uint64_t value) {
        std::string lie = whole;
        std::memcpy(lie.data() + place, &value, sizeof value);
        for (const bool isRepaired : {false, true}) {
            const auto fixed = withRightChecksums(std::as_bytes(std::span(lie)));
            std::string bytes(lie);
            if (isRepaired) bytes.assign(reinterpret_cast<const char*>(fixed.data()), fixed.size());
            if (bytes == whole) continue;  // the lie stood where repairing puts the truth
            writeFile(folder / "lie.ssc", bytes);
            const auto what = [&] { return fmt::format("{} at byte {}", value, place); };
            const auto start = std::chrono::steady_clock::now();
            row.expect(isRefused(folder / "lie.ssc", passes), what);
            const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
            seconds.add(took.count(), what);
        }
    };
    for (const std::uint64_t value :
         {1ull << 63, (1ull << 63) / 28, ~0ull, 1ull << 32, 1ull << 40}) {
        for (const std::size_t field :
             {offsetof(CacheHeader, sectionCount), offsetof(CacheHeader, tableOffset),
              offsetof(CacheHeader, fileBytes)})
            tryIt(field, value);
        const std::uint64_t entriesEnd =
            header.tableOffset + header.sectionCount * sizeof(CacheEntry);
        for (std::uint64_t entry = header.tableOffset; entry < entriesEnd;
             entry += sizeof(CacheEntry))
            for (const std::size_t field :
                 {offsetof(CacheEntry, count), offsetof(CacheEntry, offset),
                  offsetof(CacheEntry, bytes)})
                tryIt(entry + field, value);
    }
    report.add(row);
    report.add(seconds);
}

// Kept exitance that is damaged is never used: a warning, and the same values computed anew.
void damagedExitance(const TemporaryFolder& folder, const Passes& passes, Report& report) {
    Row row("caches", "exitance cut or flipped: a warning, nothing used", 0);
    const BodyInputs inputs = worldInputs(passes.world(), passes.optics())[0];
    ExitanceCache cache(exitanceFileOf(folder / "good.ssc"),
                        {exitanceFingerprint(passes.world(), 0, inputs)});
    CountingReporter reporter;
    const auto known = passes.fields();
    for (FaceIndex face = 0; face < passes.world().bodies()[0].mesh.faceCount(); ++face)
        known[0]->exitance(face, Vec2(0.2f));
    cache.save(known, reporter);
    const std::string whole = readFile(cache.file());
    const auto reuse = passes.fields();
    row.expect(cache.load(reuse, reporter) > 0 && reporter.warnings == 0,
               [] { return "the whole file is not used"; });
    const auto fields = passes.fields();
    forEachDamage(whole, [&](const std::string& bytes, const std::string& what) {
        writeFile(cache.file(), bytes);
        const int before = reporter.warnings;
        const bool isUnused = cache.load(fields, reporter) == 0;
        row.expect(isUnused && reporter.warnings == before + 1, [&] { return what; });
    });
    report.add(row);
}

}  // namespace

void stressCaches(Report& report, Scope /*scope*/) {
    const TemporaryFolder folder;
    testing::SceneMaker maker =
        bodyScene(BoxShape{DVec3(4)}, toMedium(*findMeasuredMedium("Marble")));
    maker.scene.quality.spacingMm = 2;
    const Passes passes(maker.scene);
    testing::writeCache(folder / "good.ssc", passes.world(), passes.optics(), passes.clouds(),
                        passes.reports());
    damagedClouds(folder, passes, report);
    bombs(folder, passes, report);
    damagedExitance(folder, passes, report);
}

}  // namespace sss::stress
