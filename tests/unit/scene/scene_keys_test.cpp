#include "sss/base/json.h"
#include "sss/medium/measured_media.h"
#include "sss/medium/profile.h"
#include "sss/scene/metal_table.h"
#include "sss/scene/scene_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace sss {
namespace {

namespace fs = std::filesystem;

const JsonValue& at(const JsonValue& object, std::string_view key) {
    const JsonMember* member = object.find(key);
    if (member == nullptr) throw std::runtime_error("no " + std::string(key));
    return member->value;
}

JsonValue schemaDefinitions() {
    return at(readJsonFile(fs::path(SSS_SOURCE_DIR) / "scenes/scene.schema.json"), "$defs");
}

std::string readme() {
    std::ifstream file(fs::path(SSS_SOURCE_DIR) / "scenes/README.md");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(SceneKeys, AreExactlyThoseOfTheSchema) {
    const JsonValue definitions = schemaDefinitions();
    std::set<std::string> owners;
    for (const KeyList& list : sceneKeys()) {
        SCOPED_TRACE(list.owner);
        owners.insert(list.owner);
        const JsonMember* definition = definitions.find(list.owner);
        ASSERT_NE(definition, nullptr);
        std::set<std::string> inSchema;
        for (const JsonMember& member : at(definition->value, "properties").members()) {
            inSchema.insert(member.key);
        }
        EXPECT_EQ(std::set<std::string>(list.keys.begin(), list.keys.end()), inSchema);
        EXPECT_EQ(list.keys.size(), inSchema.size());
        EXPECT_FALSE(at(definition->value, "additionalProperties").asBool());
    }
    // And no kind of object stands in the schema that the reader does not know.
    for (const JsonMember& member : definitions.members()) {
        if (member.value.find("properties") == nullptr) continue;
        EXPECT_TRUE(owners.contains(member.key)) << member.key;
    }
}

TEST(SceneKeys, AllStandInTheReadme) {
    const std::string text = readme();
    for (const KeyList& list : sceneKeys()) {
        for (const std::string_view key : list.keys) {
            EXPECT_NE(text.find("`" + std::string(key) + "`"), std::string::npos)
                << list.owner << " " << key;
        }
    }
}

/// The names that a table offers, the schema lists and the README mentions are the same.
template <typename Table>
void expectNames(const Table& table, const JsonValue& property) {
    const std::string text = readme();
    std::set<std::string> inCode, inSchema;
    for (const auto& row : table) {
        inCode.insert(std::string(row.name));
        EXPECT_NE(text.find("`" + std::string(row.name) + "`"), std::string::npos) << row.name;
    }
    for (const JsonValue& name : at(property, "enum").items()) inSchema.insert(name.asString());
    EXPECT_EQ(inCode, inSchema);
}

TEST(SceneKeys, NamesOfMediaProfilesAndMetalsAreThoseOfTheSchemaAndTheReadme) {
    const JsonValue definitions = schemaDefinitions();
    const JsonValue& translucent = at(at(definitions, "material.translucent"), "properties");
    expectNames(measuredMedia(), at(translucent, "medium"));
    expectNames(profileTable(), at(translucent, "profile"));
    expectNames(metalTable(), at(at(at(definitions, "material.metal"), "properties"), "metal"));
}

}  // namespace
}  // namespace sss
