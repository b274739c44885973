// Tests JSON with positions: values, positions, and every way in which a text can be wrong.
#include "framework/base/json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace fovea::json {
namespace {

using testing::HasSubstr;
using Type = Value::Type;

// The errors, each as "line:column message".
std::vector<std::string> errorsOf(const std::string& text) {
  try {
    parse(text, "f.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::BadInput);
    std::vector<std::string> lines;
    for (const Diagnostic& d : error.diagnostics()) {
      EXPECT_EQ(d.where.file, "f.json");
      lines.push_back(std::to_string(d.where.line) + ":" + std::to_string(d.where.column) + " " + d.message);
    }
    return lines;
  }
  return {};
}

TEST(Json, ReadsEveryTypeWithItsPlace) {
  const Value v = parse(
      "{\n  \"a\": null, \"b\": true,\n  \"c\": -12, \"d\": 1.5e3,\n\t\"e\": \"x\\ny\", \"f\": [1, [2]] , "
      "\"g\": {}\n}",
      "f.json");
  ASSERT_EQ(v.type, Type::Object);
  ASSERT_EQ(v.members.size(), 7u);
  EXPECT_EQ(v.where.line, 1);
  EXPECT_EQ(v.where.column, 1);
  auto expect = [&](const char* key, Type type, int keyColumn, int line, int column) {
    const Member* m = v.findMember(key);
    ASSERT_NE(m, nullptr) << key;
    EXPECT_EQ(m->value.type, type) << key;
    EXPECT_EQ(m->keyWhere.line, line) << key;
    EXPECT_EQ(m->keyWhere.column, keyColumn) << key;
    EXPECT_EQ(m->value.where.line, line) << key;
    EXPECT_EQ(m->value.where.column, column) << key;
    EXPECT_EQ(*m->value.where.file, "f.json");
  };
  expect("a", Type::Null, 3, 2, 8);
  expect("b", Type::Bool, 14, 2, 19);
  expect("c", Type::Int, 3, 3, 8);
  expect("d", Type::Real, 13, 3, 18);
  expect("e", Type::String, 2, 4, 7);
  expect("f", Type::Array, 15, 4, 20);
  expect("g", Type::Object, 31, 4, 36);
  EXPECT_TRUE(v.find("b")->boolean);
  EXPECT_EQ(v.find("c")->integer, -12);
  EXPECT_EQ(v.find("c")->real, -12.0);
  EXPECT_EQ(v.find("d")->real, 1500.0);
  EXPECT_EQ(v.find("e")->string, "x\ny");
  ASSERT_EQ(v.find("f")->items.size(), 2u);
  EXPECT_EQ(v.find("f")->items[1].items[0].where.column, 25);
  EXPECT_EQ(v.find("nothing"), nullptr);
}

TEST(Json, ColumnsCountCharactersNotBytes) {
  const Value v = parse("{\"äöü€\": \"😀\", \"b\": 1}", "f.json");
  EXPECT_EQ(v.members[0].key, "äöü€");
  EXPECT_EQ(v.members[0].value.where.column, 10);
  EXPECT_EQ(v.members[1].keyWhere.column, 15);
}

TEST(Json, EscapesDoNotShiftPlaces) {
  const Value v = parse(R"(["\"", "\\", "\u00e9,]", 7])", "f.json");
  ASSERT_EQ(v.items.size(), 4u);
  EXPECT_EQ(v.items[3].where.column, 26);
  EXPECT_EQ(v.items[2].string, "é,]");
}

TEST(Json, WindowsLineEndsCountOnce) {
  EXPECT_EQ(parse("[\r\n1,\r\n2]", "f.json").items[1].where.line, 3);
  EXPECT_EQ(parse("[\r\n1,\r\n2]", "f.json").items[1].where.column, 1);
}

TEST(Json, NumbersKeepTheirKind) {
  const Value v =
      parse("[9223372036854775807, -9223372036854775808, 9223372036854775808, 1.0, 1e2, -0]", "f.json");
  EXPECT_EQ(v.items[0].integer, INT64_MAX);
  EXPECT_EQ(v.items[1].integer, INT64_MIN);
  EXPECT_EQ(v.items[2].type, Type::Real);  // too large for an int64
  EXPECT_EQ(v.items[3].type, Type::Real);
  EXPECT_EQ(v.items[4].type, Type::Real);
  EXPECT_EQ(v.items[5].type, Type::Int);
}

TEST(Json, WholeNumbersInEverySpelling) {
  for (const char* text : {"500", "500.0", "5e2", "5E+2", "0.5e3", "50000e-2", "5.00e2"}) {
    const Value v = parse(text, "f.json");
    EXPECT_TRUE(v.isInt()) << text;
    EXPECT_EQ(v.integer, 500) << text;
    EXPECT_EQ(v.real, 500.0) << text;
  }
  EXPECT_TRUE(parse("-0.0", "f.json").isInt());
  EXPECT_TRUE(parse("-4.0", "f.json").isInt());
  EXPECT_EQ(parse("-9.223372036854774e18", "f.json").integer, -9223372036854773760);
  for (const char* text : {"500.5", "1e30", "-1e30", "9223372036854775808", "1e-3", "4.000001"}) {
    EXPECT_FALSE(parse(text, "f.json").isInt()) << text;
    EXPECT_EQ(parse(text, "f.json").integer, 0) << text;
  }
}

struct Bad {
  const char* text;
  const char* where;
  const char* says;
};

class JsonErrors : public testing::TestWithParam<Bad> {};

TEST_P(JsonErrors, AreLocated) {
  const std::vector<std::string> errors = errorsOf(GetParam().text);
  ASSERT_EQ(errors.size(), 1u) << GetParam().text;
  EXPECT_THAT(errors[0], testing::StartsWith(std::string(GetParam().where) + " ")) << GetParam().text;
  EXPECT_THAT(errors[0], HasSubstr(GetParam().says)) << GetParam().text;
  EXPECT_THAT(errors[0], testing::Not(HasSubstr("json.exception")));
}

INSTANTIATE_TEST_SUITE_P(
    All, JsonErrors,
    testing::Values(Bad{"", "1:1", "end of input"}, Bad{"   \n ", "2:2", "end of input"},
                    Bad{"{\"a\": 1,\n \"b\": nul}", "2:7", "invalid literal"},
                    Bad{"{\"a\":1,}", "1:8", "unexpected '}'"}, Bad{"{\"a\" 1}", "1:6", "expected ':'"},
                    Bad{"[1,,2]", "1:4", "unexpected ','"}, Bad{"[1] 2", "1:5", "expected end of input"},
                    Bad{"{} {}", "1:4", "expected end of input"}, Bad{"[1", "1:3", "end of input"},
                    Bad{"{\"a\": [1, 2}", "1:12", "expected ']'"}, Bad{"[1e999]", "1:2", "overflow"},
                    Bad{"[NaN]", "1:2", "invalid literal"}, Bad{"[Infinity]", "1:2", "invalid literal"},
                    Bad{"[-]", "1:2", "invalid number"}, Bad{"[01]", "1:3", "expected ']'"},
                    Bad{"[1.]", "1:2", "invalid number"}, Bad{"['a']", "1:2", "invalid literal"},
                    Bad{"{a: 1}", "1:2", "invalid literal"}, Bad{"\"abc", "1:1", "missing closing quote"},
                    Bad{"[\"a\tb\"]", "1:2", "control character"},
                    Bad{"[\"\\x\"]", "1:2", "forbidden character after backslash"},
                    Bad{"[\"\\ud800\"]", "1:2", "surrogate"}, Bad{"[\"\xff\"]", "1:2", "UTF-8"},
                    Bad{"// no comments\n{}", "1:1", "invalid literal"},
                    Bad{"\xEF\xBB\xBF\xEF\xBB\xBF{}", "1:1", "two byte-order marks"},
                    Bad{"\xFF\xFE{", "1:1", "UTF-16"}, Bad{"\xFE\xFF", "1:1", "UTF-16"},
                    Bad{"\xEF\xBB\xBF{\"a\": 01}", "1:8", "expected '}'"},
                    Bad{"{\"a\":1,\n\"b\":2, \"a\":3}", "2:8", "occurs twice"}));

TEST(Json, AByteOrderMarkAndCrLfAreNoPartOfTheText) {
  const Value v = parse("\xEF\xBB\xBF{\r\n \"a\": [1]\r\n}\r\n", "f");
  EXPECT_EQ(v.where.column, 1);
  EXPECT_EQ(v.find("a")->where.line, 2);
  EXPECT_EQ(v.find("a")->where.column, 7);
}

TEST(Json, WholeNumbersHoweverTheyAreWritten) {
  for (const char* text : {"500", "500.0", "5e2", "0.5E3"}) {
    EXPECT_TRUE(parse(text, "f").isInt()) << text;
    EXPECT_EQ(parse(text, "f").integer, 500) << text;
  }
  EXPECT_TRUE(parse("-0.0", "f").isInt());
  EXPECT_EQ(parse("9007199254740993", "f").integer, 9007199254740993);
  for (const char* text : {"500.5", "1e30", "-1e-9", "\"500\"", "true", "null", "[5]"})
    EXPECT_FALSE(parse(text, "f").isInt()) << text;
}

TEST(Json, ANulByteIsNotTheEnd) {
  const std::vector<std::string> errors = errorsOf(std::string("{}\0 anything", 12));
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0], "1:3 the file contains a NUL byte");
}

TEST(Json, AllDuplicateKeysAreReportedAtOnce) {
  const std::vector<std::string> errors = errorsOf("{\"a\":1,\"a\":2,\n\"b\":{\"c\":1,\n\"c\":2}, \"b\":1}");
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_THAT(errors[0], HasSubstr("1:8 the key \"a\""));
  EXPECT_THAT(errors[1], HasSubstr("3:1 the key \"c\""));
  EXPECT_THAT(errors[2], HasSubstr("3:9 the key \"b\""));
}

TEST(Json, TheSameKeyInDifferentObjectsIsFine) {
  EXPECT_TRUE(errorsOf("{\"a\":{\"a\":{\"a\":1}}, \"b\":{\"a\":1}}").empty());
}

TEST(Json, DepthIsCapped) {
  const std::string deep = std::string(kMaxDepth, '[') + std::string(kMaxDepth, ']');
  EXPECT_TRUE(errorsOf(deep).empty());
  const std::vector<std::string> errors = errorsOf("[" + deep + "]");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0], "1:65 nested deeper than 64 levels");
  EXPECT_FALSE(errorsOf(std::string(2000000, '[')).empty());
}

TEST(Json, FilesThatCannotBeRead) {
  EXPECT_THROW(parseFile("/nowhere/at/all.json"), Error);
  EXPECT_THROW(parseFile(std::filesystem::temp_directory_path()), Error);
  try {
    parseFile("/nowhere/at/all.json");
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("/nowhere/at/all.json"));
  }
}

TEST(ObjectReader, ReadsTypedMembersAndReportsTheRest) {
  const Value v = parse(
      R"({"n": 5, "i": 2.5, "t": true, "s": "x", "c": "rde", "v": [1, 2, 3], "w": [1, "2"], "hight": 1})",
      "f.json");
  Diagnostics d;
  ObjectReader r(v, "camera", d);
  EXPECT_EQ(r.number("n", 1, 0, 10), 5.0);
  EXPECT_EQ(r.integer("i", 7), 7);
  EXPECT_TRUE(r.boolean("t", false));
  EXPECT_EQ(r.text("s"), "x");
  EXPECT_EQ(r.choice("c", "red", {"red", "green"}), "red");
  EXPECT_EQ(r.numbers("v", 3)->at(2), 3.0);
  EXPECT_FALSE(r.numbers("w", 2).has_value());
  EXPECT_EQ(r.number("height", 9), 9.0);
  EXPECT_EQ(r.require("missing"), nullptr);
  r.finish();
  ASSERT_EQ(d.list().size(), 5u) << d.format();
  EXPECT_EQ(d.list()[0].format(),
            "f.json:1:15: error: `i`: expected a whole number, found the number 2.5 (at camera.i)");
  EXPECT_EQ(d.list()[1].format(),
            "f.json:1:46: error: `c`: expected one of red, green, found the text \"rde\" (at camera.c)\n  -> "
            "did you mean `red`?");
  EXPECT_THAT(d.list()[2].message, HasSubstr("an array of 2 numbers"));
  EXPECT_THAT(d.list()[3].message, HasSubstr("`missing` is missing"));
  EXPECT_EQ(d.list()[4].format(),
            "f.json:1:84: error: unknown key `hight` (at camera.hight)\n  -> did you mean `height`?");
}

TEST(ObjectReader, RangesAreNamed) {
  const Value v = parse(R"({"a": -1, "b": 99})", "f.json");
  Diagnostics d;
  ObjectReader r(v, "", d);
  EXPECT_EQ(r.number("a", 3, 0), 3.0);
  EXPECT_EQ(r.integer("b", 4, 1, 10), 4);
  ASSERT_EQ(d.list().size(), 2u);
  EXPECT_THAT(d.list()[0].message, HasSubstr("a number of at least 0"));
  EXPECT_THAT(d.list()[1].message, HasSubstr("a whole number from 1 to 10"));
}

TEST(ObjectReader, SomethingElseThanAnObject) {
  const Value v = parse("[1]", "f.json");
  Diagnostics d;
  ObjectReader r(v, "camera", d);
  EXPECT_EQ(r.number("a", 3), 3.0);
  r.finish();
  ASSERT_EQ(d.list().size(), 1u);
  EXPECT_THAT(d.list()[0].message, HasSubstr("expected an object, found an array"));
}

}  // namespace
}  // namespace fovea::json
