#include "sss/base/json.h"

#include "sss/base/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace sss {
namespace {

JsonValue parse(std::string_view text) { return parseJson(text, "f.json"); }

JsonPlace place(int line, int column) { return {line, column}; }

/// What parsing `text` complains about.
std::string complaint(std::string_view text) {
    try {
        parse(text);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadInput);
        return error.what();
    }
    return "no error";
}

void expectComplaint(std::string_view text, const std::string& where, const std::string& part) {
    const std::string what = complaint(text);
    EXPECT_TRUE(what.starts_with("f.json:" + where + ": ")) << what;
    EXPECT_NE(what.find(part), std::string::npos) << what;
}

TEST(Json, ReadsEveryKindOfValue) {
    const JsonValue v = parse(R"([null, true, false, -1.5e2, 7, "a\u00e9\n", [], {}])");
    const auto& items = v.items();
    ASSERT_EQ(items.size(), 8u);
    EXPECT_TRUE(items[0].isNull());
    EXPECT_TRUE(items[1].asBool());
    EXPECT_FALSE(items[2].asBool());
    EXPECT_EQ(items[3].asNumber(), -150.0);
    EXPECT_EQ(items[4].asNumber(), 7.0);
    EXPECT_EQ(items[5].asString(), "a\xC3\xA9\n");
    EXPECT_TRUE(items[6].isArray() && items[6].items().empty());
    EXPECT_TRUE(items[7].isObject() && items[7].members().empty());
}

TEST(Json, ReadsNumbersToTheNearestDouble) {
    EXPECT_EQ(parse("0.1").asNumber(), 0.1);
    EXPECT_EQ(parse("9007199254740991").asNumber(), 9007199254740991.0);
    EXPECT_EQ(parse("1.7976931348623157e308").asNumber(), std::numeric_limits<double>::max());
    EXPECT_EQ(parse("-0").asNumber(), 0.0);
}

TEST(Json, KeepsTheOrderOfKeys) {
    const JsonValue v = parse(R"({"z": 1, "a": 2, "m": 3})");
    ASSERT_EQ(v.members().size(), 3u);
    EXPECT_EQ(v.members()[0].key, "z");
    EXPECT_EQ(v.members()[1].key, "a");
    EXPECT_EQ(v.members()[2].key, "m");
    EXPECT_EQ(v.find("a")->value.asNumber(), 2.0);
    EXPECT_EQ(v.find("b"), nullptr);
}

TEST(Json, KnowsLineAndColumnOfEveryKeyAndValue) {
    const JsonValue v = parse(
        "{\n"
        "  \"a\" : 12,\"b\":[1,22 ,\t\"x\"],\n"
        "\n"
        "  \"c\": {\"d\": true}, \"e\"\n"
        "   :\n"
        "     null,\r\n"
        " \"f\":-1}");
    EXPECT_EQ(v.place, place(1, 1));
    const auto& m = v.members();
    ASSERT_EQ(m.size(), 5u);
    EXPECT_EQ(m[0].keyPlace, place(2, 3));
    EXPECT_EQ(m[0].value.place, place(2, 9));
    EXPECT_EQ(m[1].keyPlace, place(2, 12));
    EXPECT_EQ(m[1].value.place, place(2, 16));
    const auto& b = m[1].value.items();
    EXPECT_EQ(b[0].place, place(2, 17));
    EXPECT_EQ(b[1].place, place(2, 19));
    EXPECT_EQ(b[2].place, place(2, 24));
    EXPECT_EQ(m[2].keyPlace, place(4, 3));
    EXPECT_EQ(m[2].value.place, place(4, 8));
    EXPECT_EQ(m[2].value.members()[0].keyPlace, place(4, 9));
    EXPECT_EQ(m[2].value.members()[0].value.place, place(4, 14));
    EXPECT_EQ(m[3].keyPlace, place(4, 21));
    EXPECT_EQ(m[3].value.place, place(6, 6));
    EXPECT_EQ(m[4].keyPlace, place(7, 2));
    EXPECT_EQ(m[4].value.place, place(7, 6));
}

TEST(Json, KnowsPlacesInNestedArraysAndAfterNumbers) {
    const JsonValue v = parse("[[1],[[2]],3]");
    const auto& items = v.items();
    EXPECT_EQ(items[0].place, place(1, 2));
    EXPECT_EQ(items[0].items()[0].place, place(1, 3));
    EXPECT_EQ(items[1].place, place(1, 6));
    EXPECT_EQ(items[1].items()[0].place, place(1, 7));
    EXPECT_EQ(items[1].items()[0].items()[0].place, place(1, 8));
    EXPECT_EQ(items[2].place, place(1, 12));
    EXPECT_EQ(parse("  5").place, place(1, 3));
}

TEST(Json, CountsColumnsInCharactersNotBytes) {
    const JsonValue v = parse("{\"\xC3\xA9\xE2\x82\xAC\": \"\xF0\x9F\x98\x80\", \"b\": 1}");
    EXPECT_EQ(v.members()[0].value.place, place(1, 8));
    EXPECT_EQ(v.members()[1].keyPlace, place(1, 13));
    EXPECT_EQ(parse("\xEF\xBB\xBF{\"a\": 1}").members()[0].keyPlace, place(1, 2));
}

TEST(Json, ReportsSyntaxErrorsWhereTheyAre) {
    expectComplaint("", "1:1", "unexpected end of input");
    expectComplaint("{\n \"a\": 1,\n}", "3:1", "unexpected '}'");
    expectComplaint("[1,,2]", "1:4", "unexpected ','");
    expectComplaint("{\"a\" 1}", "1:6", "unexpected number literal");
    expectComplaint("{\"a\": [true false]}", "1:13", "unexpected false literal");
    expectComplaint("{true: 1}", "1:2", "unexpected true literal");
    expectComplaint("{\"a\" \"bc\"}", "1:6", "unexpected string literal");
    expectComplaint("{\"a\": 1} x", "1:10", "invalid literal");
    expectComplaint("[1] [2]", "1:5", "unexpected '['");
    expectComplaint("[1\n", "2:1", "unexpected end of input");
    expectComplaint("{a: 1}", "1:2", "invalid literal");
    expectComplaint("[01]", "1:3", "unexpected number literal");
    expectComplaint("// note\n1", "1:1", "invalid literal");
    expectComplaint("[\"abc\n\"]", "1:6", "invalid string");
    expectComplaint("[\"\\x\"]", "1:4", "invalid string");
}

TEST(Json, RefusesNumbersThatAreNotFinite) {
    expectComplaint("[1, 1e400]", "1:5", "1e400");
    expectComplaint("[-1e400]", "1:2", "-1e400");
    expectComplaint("[NaN]", "1:2", "no NaN, no Infinity");
    expectComplaint("{\"a\": Infinity}", "1:7", "no NaN, no Infinity");
    expectComplaint("[-Infinity]", "1:3", "invalid number");
}

TEST(Json, RefusesDuplicateKeys) {
    expectComplaint("{\"a\": 1,\n \"b\": 2, \"a\": 3}", "2:10", "the key \"a\" stands twice");
    EXPECT_EQ(complaint(R"([{"a": 1}, {"a": {"a": 2}}])"), "no error");
}

TEST(Json, RefusesInvalidUtf8) {
    expectComplaint("[\"a\xFF\"]", "1:4", "ill-formed UTF-8");
    expectComplaint("[\"\xC3\"]", "1:4", "ill-formed UTF-8");
    expectComplaint("[\"\xC0\xAF\"]", "1:3", "ill-formed UTF-8");  // overlong
    expectComplaint("[\"\\ud800\"]", "1:9", "surrogate");
}

TEST(Json, RefusesDeepNesting) {
    const auto nested = [](int depth) {
        return std::string(static_cast<std::size_t>(depth), '[') +
               std::string(static_cast<std::size_t>(depth), ']');
    };
    EXPECT_EQ(complaint(nested(kMaxJsonDepth)), "no error");
    expectComplaint(nested(kMaxJsonDepth + 1), "1:65", "nested deeper than 64");
    expectComplaint(nested(100000), "1:65", "nested deeper than 64");
}

TEST(Json, RefusesFilesOverTheLimit) {
    const std::string text(kMaxJsonBytes + 1, ' ');
    EXPECT_NE(complaint(text).find("more than 64 MiB"), std::string::npos);
}

TEST(Json, ReadsFilesAndNamesThoseThatItCannot) {
    const auto file = std::filesystem::temp_directory_path() / "sss_json_test.json";
    std::ofstream(file) << "{\"a\": [1, 2}";
    try {
        readJsonFile(file);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), file.string() + ":1:12");
    }
    std::ofstream(file) << "{\"a\": 1}";
    EXPECT_EQ(readJsonFile(file).find("a")->value.asNumber(), 1.0);
    std::filesystem::remove(file);
    for (const auto& bad : {file, std::filesystem::temp_directory_path()}) {
        try {
            readJsonFile(bad);
            FAIL() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Io);
            EXPECT_EQ(error.where(), bad.string());
        }
    }
}

// A file that opens and whose reading fails; where there is none, the sentence stays untried.
TEST(Json, SaysThatAFileCannotBeReadToItsEnd) {
    const std::filesystem::path unreadable = "/proc/self/mem";
    if (!std::filesystem::exists(unreadable)) GTEST_SKIP();
    try {
        readJsonFile(unreadable);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Io);
        EXPECT_EQ(std::string(error.what()),
                  unreadable.string() + ": the file cannot be read to its end");
    }
}

TEST(Json, WritesWhatItBuilds) {
    JsonValue v = JsonValue::object();
    v.set("points", std::size_t{118204}).set("spacingMm", 0.42).set("file", "a \"b\"\n");
    v.set("mfp", JsonValue::array({0.5, -2, 1e300})).set("quiet", false).set("none", {});
    EXPECT_EQ(dump(v, -1), R"({"points":118204,"spacingMm":0.42,"file":"a \"b\"\n",)"
                           R"("mfp":[0.5,-2,1e+300],"quiet":false,"none":null})");
    v.set("points", 3);  // replaces, in its place
    EXPECT_EQ(v.members()[0].value.asNumber(), 3.0);
    EXPECT_EQ(v.members().size(), 6u);
    EXPECT_EQ(dump(JsonValue::array().push(1).push(JsonValue::object().set("a", 2)), 2),
              "[\n  1,\n  {\n    \"a\": 2\n  }\n]");
}

TEST(Json, WritesOnlyValidJson) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(dump(JsonValue::array({nan, infinity, -infinity}), -1), "[null,null,null]");
    EXPECT_EQ(dump(JsonValue("a\xFF"), -1), "\"a\xEF\xBF\xBD\"");
}

TEST(Json, ReadsBackWhatItWrites) {
    const std::string text =
        R"({"z":[1,2.5,-0.1,1e-300,9007199254740991],"a":{"b":"\u0001€","c":[]},"d":null})";
    const JsonValue once = parse(text);
    EXPECT_EQ(dump(parse(dump(once, 2)), -1), dump(once, -1));
    EXPECT_EQ(parse(dump(JsonValue(0.1 + 0.2))).asNumber(), 0.1 + 0.2);
}

}  // namespace
}  // namespace sss
