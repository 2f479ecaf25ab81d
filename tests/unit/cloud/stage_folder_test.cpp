#include "sss/cloud/stage_folder.h"

#include "sss/base/error.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

namespace sss {
namespace {

using testing::TemporaryFolder;

struct Warnings final : Reporter {
    std::vector<std::string> all;
    void info(std::string_view, std::string_view) override {}
    void warn(std::string_view, std::string_view sentence) override { all.emplace_back(sentence); }
    void progress(std::string_view, double, double, bool) override {}
};

constexpr Fingerprint kMade{0x0123456789abcdef, 0xfedcba9876543210};

void write(const StageFolder& folder, Stage stage) {
    CacheWriter writer(folder.file(stage, kMade));
    writer.addText("meta", 0, kMade, "something");
    writer.commit();
}

TEST(StageFolder, NamesStagesByWhatTheyAreMadeFrom) {
    const TemporaryFolder place;
    const auto wordsOf = [](const std::filesystem::path& path, bool create) -> std::string {
        try {
            StageFolder(path, create);
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(
        wordsOf(place / "deep/in/it", false),
        (place / "deep/in/it").string() + ": there is no such folder; run sss-preprocess first");
    std::ofstream(place / "file").flush();
    EXPECT_NE(wordsOf(place / "file/in", true).find("cannot make the folder: "), std::string::npos);
    const StageFolder folder(place / "deep/in/it", true);
    EXPECT_EQ(folder.file(Stage::Points, kMade).filename(),
              "points-fedcba98765432100123456789abcdef.ssp");
    Warnings warnings;
    EXPECT_FALSE(folder.open(Stage::Irradiance, kMade, warnings));
    write(folder, Stage::Irradiance);
    EXPECT_FALSE(folder.open(Stage::Exitance, kMade, warnings));
    const auto file = folder.open(Stage::Irradiance, kMade, warnings);
    ASSERT_TRUE(file);
    EXPECT_EQ(file->text("meta", 0), "something");
    EXPECT_TRUE(warnings.all.empty());
    EXPECT_EQ(folder.all(Stage::Irradiance).size(), 1u);
    EXPECT_TRUE(folder.all(Stage::Points).empty());
}

TEST(StageFolder, DamageIsSaidAndNotUsed) {
    const TemporaryFolder place;
    const StageFolder folder(place / "c", true);
    write(folder, Stage::Points);
    std::fstream(folder.file(Stage::Points, kMade), std::ios::in | std::ios::out)
        .seekp(70)
        .put('x');
    Warnings warnings;
    EXPECT_FALSE(folder.open(Stage::Points, kMade, warnings));
    ASSERT_EQ(warnings.all.size(), 1u);
    EXPECT_NE(warnings.all[0].find("points-fedc"), std::string::npos) << warnings.all[0];
}

TEST(StageFolder, OneAtATimeMakesAStage) {
    const TemporaryFolder place;
    const StageFolder folder(place / "c", true);
    std::atomic<bool> isWaiting{false}, isReleased{false};
    auto held = std::make_unique<StageFolder::Lock>(folder.lock(Stage::Points, kMade, [] {}));
    // Other stages are free.
    bool waited = false;
    folder.lock(Stage::Points, {kMade.lo ^ 0xff00, 0}, [&] { waited = true; });
    EXPECT_FALSE(waited);
    std::thread other([&] {
        const auto lock = folder.lock(Stage::Points, kMade, [&] { isWaiting = true; });
        EXPECT_TRUE(isReleased);
    });
    while (!isWaiting) std::this_thread::yield();
    isReleased = true;
    held.reset();
    other.join();
}

}  // namespace
}  // namespace sss
