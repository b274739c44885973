// Tests the generated JSON schema: its structure here, and real validation with python3 jsonschema where
// that is installed.
#include "framework/graph/report/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "framework/base/json.h"
#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

const json::Value& at(const json::Value& v, const std::vector<std::string>& path) {
  const json::Value* value = &v;
  for (const std::string& key : path) {
    value = value->find(key);
    if (!value) throw std::runtime_error("no " + key);
  }
  return *value;
}

TEST(Schema, HoldsWhatThePassesDeclare) {
  const auto registry = basicRegistry();
  const json::Value s = json::parse(generateSchema(*registry), "schema");
  EXPECT_EQ(at(s, {"$schema"}).string, "http://json-schema.org/draft-07/schema#");
  EXPECT_FALSE(at(s, {"additionalProperties"}).boolean);
  const json::Value& pass = at(s, {"properties", "passes", "additionalProperties"});
  // One more for types that end in a graph parameter.
  EXPECT_EQ(at(pass, {"properties", "type", "oneOf"}).items.size(), registry->types().size() + 1);
  EXPECT_EQ(at(pass, {"allOf"}).items.size(), registry->types().size());
  const json::Value& source = at(s, {"definitions", "pass-source", "properties"});
  const json::Value& count = at(source, {"params", "properties", "count"});
  EXPECT_EQ(at(count, {"description"}).string, "a number");
  EXPECT_EQ(at(count, {"default"}).integer, 3);
  EXPECT_EQ(at(at(count, {"anyOf"}).items[0], {"minimum"}).integer, 1);
  EXPECT_EQ(at(at(count, {"anyOf"}).items[0], {"maximum"}).integer, 10);
  EXPECT_EQ(at(source, {"params", "properties", "radius", "description"}).string, "a length [m]");
  EXPECT_EQ(at(at(source, {"params", "properties", "kernel", "anyOf"}).items[0], {"enum"}).items.size(), 2u);
  const json::Value& shade = at(s, {"definitions", "pass-shade", "properties", "inputs", "properties"});
  ASSERT_EQ(shade.members.size(), 2u);
  EXPECT_EQ(at(shade, {"gbuffer", "description"}).string, "surfaces (bundle gbuffer: position depth)");
  EXPECT_EQ(at(shade, {"vpls", "description"}).string, "lights (buffer of Vpl, 64 bytes each, optional)");
  EXPECT_NE(at(s, {"definitions", "pass-emit", "description"}).string.find("vpls: lights (buffer of Vpl"),
            std::string::npos);
  EXPECT_EQ(at(s, {"definitions", "pass-emit", "description"}).string.find("paths"),
            std::string::npos);  // scratch
}

TEST(Schema, OfAnEmptyRegistryIsStillJson) {
  EXPECT_NO_THROW(json::parse(generateSchema(Registry()), "schema"));
}

struct Case {
  const char* graph;
  bool valid;
};

// The schema must accept and refuse the same as the compiler, wherever a single file is enough to decide.
const Case kCases[] = {
    {R"({"$schema": "x", "description": "d", "extends": "b.json", "parameters": {"n": 1}, "passes": {}, "outputs": {}})",
     true},
    {R"({"parameters": {"r": 1}, "passes": {"a": {"type": "source", "params": {"count": 5, "radius": "$r", "kernel": "disc", "fast": true}}}, "outputs": {"o": "a.image"}})",
     true},
    {R"({"passes": {"a": null, "b": {"params": {"count": 5}}, "f": {"type": "filter", "inputs": {"image": "left/a.image@previous"}}}})",
     true},
    {R"({"passes": {"left": {"graph": "eye.json", "view": "left", "parameters": {"r": 1}, "inputs": {"vpls": "emit.vpls"}}}})",
     true},
    {R"({"inputs": {"i": {"format": "rgba16f", "width": 4, "height": "$h"}, "v": {"element": "Vpl", "stride": 64, "count": 2},
        "g": {"bundle": "gbuffer", "members": {"depth": {"format": "d32f"}}}, "s": {"doc": "x", "optional": true}}})",
     true},
    {R"({"passes": {"a": {"type": "source", "params": {"radius": "$r"}}}})", false},
    {R"({"pases": {}})", false},
    {R"({"passes": {"a": {"type": "sourse"}}})", false},
    {R"({"passes": {"a": {"type": "source", "parms": {}}}})", false},
    {R"({"passes": {"a": {"type": "source", "graph": "x.json"}}})", false},
    {R"({"passes": {"a": {"type": "source", "params": {"cuont": 5}}}})", false},
    {R"({"passes": {"a": {"type": "source", "params": {"count": 11}}}})", false},
    {R"({"passes": {"a": {"type": "source", "params": {"count": 1.5}}}})", false},
    {R"({"passes": {"a": {"type": "source", "params": {"kernel": "disk"}}}})", false},
    {R"({"passes": {"f": {"type": "filter", "inputs": {"imge": "a"}}}})", false},
    {R"({"passes": {"f": {"type": "filter", "inputs": {"image": "a@last"}}}})", false},
    {R"({"passes": {"f": {"type": "filter", "inputs": {"image": 1}}}})", false},
    {R"({"inputs": {"i": {"format": "rgba17"}}})", false},
    {R"({"parameters": {"n": []}})", false},
};

TEST(Schema, AcceptsAndRefusesAsTheCompilerDoes) {
  if (std::system("python3 -c 'import jsonschema' > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "python3 jsonschema is not installed (apt: python3-jsonschema)";
  TempFolder folder;
  const auto registry = basicRegistry();
  folder.write("schema.json", generateSchema(*registry));
  folder.write(
      "check.py",
      "import json, sys, jsonschema\n"
      "schema = json.load(open(sys.argv[1]))\n"
      "jsonschema.Draft7Validator.check_schema(schema)\n"
      "v = jsonschema.Draft7Validator(schema)\n"
      "bad = [f for f in sys.argv[2:] if v.is_valid(json.load(open(f))) != ('good' in f.split('/')[-1])]\n"
      "print('\\n'.join(bad))\n"
      "sys.exit(1 if bad else 0)\n");
  std::string command = fmt::format("python3 {0}/check.py {0}/schema.json", folder.path().string());
  int index = 0;
  for (const Case& c : kCases)
    command +=
        " " + folder.write(fmt::format("{}{}.json", c.valid ? "good" : "bad", index++), c.graph).string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace fovea::graph::test
