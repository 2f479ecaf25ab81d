// Folders of stages in which one file is damaged.
#include "fuzz/repair.h"
#include "numbers/damage.h"
#include "numbers/passes.h"
#include "numbers/subjects.h"
#include "sss/app/stage_chain.h"
#include "sss/base/error.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>

#include <map>

namespace sss::stress {
namespace {

/// A stage's files, and which others must be gone for a run to come to them.
struct TriedStage {
    const char* name;
    const char* extension;
    std::vector<std::string> gone;
};
const TriedStage kTried[] = {
    {"points", ".ssp", {".ssi", ".ssb", ".ssd"}},
    {"irradiance", ".ssi", {}},
    {"beams", ".ssb", {".ssd"}},
    {"shape", ".ssd", {}},
    {"exitance", ".sse", {}},
};

/// A folder's files by extension; there is one of each.
using Files = std::map<std::string, std::pair<std::filesystem::path, std::string>>;

Files filesIn(const std::filesystem::path& folder) {
    Files files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().filename() != "lock")
            files[entry.path().extension()] = {entry.path(), testing::readFile(entry.path())};
    return files;
}

template <typename T>
void append(std::string& bytes, std::span<const T> values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

/// Pass 1 and a look at the body by way of a folder: what pass 2 is given and finds, as
/// bytes.
std::string passBy(const std::filesystem::path& folder, const std::shared_ptr<const World>& world,
                   Reporter& reporter) {
    RunStats stats("sss-stress");
    StageChain chain({.folder = folder, .limits = {}}, reporter, stats);
    chain.prepare(world, nullptr);
    std::string bytes;
    for (const CachedBody& body : chain.clouds()) {
        append(bytes, body.cloud.cloud.points);
        append(bytes, body.cloud.cloud.irradiance);
        append(bytes, body.cloud.nodes);
        append(bytes, body.cloud.solved);
    }
    ExitanceChain exitance(chain.folder(), reporter, stats);
    const auto fields = exitance.fields(chain.fieldInputs(), world->scene().quality.tolerance, {});
    const Rgb seen = fields[0]->exitance(0, Vec2(0.2f));
    append(bytes, std::span(&seen, 1));
    exitance.finishFrame(true);
    return bytes;
}

class DamagedFolder {
public:
    DamagedFolder()
        : world_(std::make_shared<const World>(shapeScene(), silent_)),
          truth_(passBy(folder_.path(), world_, silent_)),
          whole_(filesIn(folder_.path())) {}

    const std::string& whole(const TriedStage& stage) const {
        return whole_.at(stage.extension).second;
    }
    /// Whether opening and reading the stage's file ends in an error that names it.
    bool isRefused(const TriedStage& stage, const std::string& bytes) const {
        const std::filesystem::path& file = whole_.at(stage.extension).first;
        testing::writeFile(file, bytes);
        try {
            CacheFile::open(file).checkAll();
            return false;
        } catch (const Error& error) {
            return error.kind() == ErrorKind::BadInput && error.where() == file.string();
        }
    }
    /// What is wrong with a run that finds these bytes; empty if it warns and comes to the same.
    std::string complaint(const TriedStage& stage, const std::string& bytes) const {
        lay(stage, bytes);
        CountingReporter reporter;
        if (passBy(folder_.path(), world_, reporter) != truth_) return "another outcome";
        if (reporter.warnings == 0) return "no warning";
        for (const auto& [extension, file] : filesIn(folder_.path()))
            CacheFile::open(file.first).checkAll();
        return {};
    }
    /// The same where the file bears the right checksums of a wrong content.
    std::string complaintOfLie(const TriedStage& stage, const std::string& bytes) const {
        const auto fixed = withRightChecksums(std::as_bytes(std::span(bytes)));
        lay(stage, {reinterpret_cast<const char*>(fixed.data()), fixed.size()});
        CountingReporter reporter;
        try {
            passBy(folder_.path(), world_, reporter);
            return {};
        } catch (const Error& error) {
            return error.kind() == ErrorKind::BadInput ? "" : error.what();
        }
    }

private:
    static Scene shapeScene() {
        testing::SceneMaker maker =
            bodyScene(BoxShape{DVec3(3)}, toMedium(*findMeasuredMedium("Marble")), true);
        maker.scene.quality.spacingMm = 1;
        return maker.scene;
    }
    void lay(const TriedStage& stage, const std::string& bytes) const {
        for (const auto& [extension, file] : whole_) {
            const bool isGone = std::ranges::count(stage.gone, extension) > 0;
            if (isGone)
                std::filesystem::remove(file.first);
            else
                testing::writeFile(file.first, extension == stage.extension ? bytes : file.second);
        }
    }

    testing::TemporaryFolder folder_;
    SilentReporter silent_;
    std::shared_ptr<const World> world_;
    std::string truth_;
    Files whole_;
};

}  // namespace

void stressStages(Report& report, Scope scope) {
    const DamagedFolder folder;
    // A run takes as long as a thousand openings.
    const int everyRun = scope == Scope::Full ? 10 : 307;
    Row refused("stages", "a stage's file cut or flipped: refused by name", 0);
    Row same("stages", "a run with a damaged stage: a warning, the same outcome", 0);
    Row lies("stages", "a stage with right checksums of wrong content: no crash", 0);
    for (const TriedStage& stage : kTried) {
        int count = 0;
        forEachDamage(folder.whole(stage), [&](const std::string& bytes, const std::string& what) {
            const auto tell = [&](const std::string& complaint) {
                return fmt::format("{} {}: {}", stage.name, what, complaint);
            };
            refused.expect(folder.isRefused(stage, bytes), [&] { return tell("accepted"); });
            if (count++ % everyRun != 0) return;
            const std::string complaint = folder.complaint(stage, bytes);
            same.expect(complaint.empty(), [&] { return tell(complaint); });
            const std::string lie = folder.complaintOfLie(stage, bytes);
            lies.expect(lie.empty(), [&] { return tell(lie); });
        });
    }
    for (const Row& row : {refused, same, lies}) report.add(row);
}

}  // namespace sss::stress
