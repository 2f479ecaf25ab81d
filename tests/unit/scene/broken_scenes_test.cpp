#include "sss/base/error.h"
#include "sss/scene/scene_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

namespace sss {
namespace {

namespace fs = std::filesystem;

/// broken/NAME.json holds one mistake each; broken/NAME.expected the line:column and the message
/// (and "beyond the schema" for schema_test.py).
std::vector<fs::path> brokenScenes() {
    std::vector<fs::path> files;
    for (const auto& entry :
         fs::directory_iterator(fs::path(SSS_SOURCE_DIR) / "tests/unit/scene/broken")) {
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    return files;
}

TEST(BrokenScenes, AreRefusedAtTheRightPlaceWithTheRightWords) {
    const std::vector<fs::path> files = brokenScenes();
    ASSERT_GE(files.size(), 100u);
    for (const fs::path& file : files) {
        SCOPED_TRACE(file.filename().string());
        std::string place, message;
        std::ifstream expected(fs::path(file).replace_extension(".expected"));
        ASSERT_TRUE(std::getline(expected, place) && std::getline(expected, message));
        try {
            readScene(file);
            ADD_FAILURE() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::BadInput);
            EXPECT_EQ(error.where(), file.string() + ":" + place);
            EXPECT_EQ(std::string(error.what()), error.where() + ": " + message);
        }
    }
}

TEST(BrokenScenes, MissingFileIsAnIoError) {
    try {
        readScene("/nonexistent/scene.json");
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Io);
        EXPECT_EQ(error.where(), "/nonexistent/scene.json");
    }
}

}  // namespace
}  // namespace sss
