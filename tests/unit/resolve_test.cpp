// Tests resolve: extends, parameters, overrides and sub-graphs.
#include "framework/graph/resolve/resolve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

using testing::HasSubstr;

// A value as compact JSON, for comparing merges with those of RFC 7396.
std::string compact(const json::Value& v) {
  switch (v.type) {
    case json::Value::Type::Null:
      return "null";
    case json::Value::Type::Bool:
      return v.boolean ? "true" : "false";
    case json::Value::Type::Int:
      return std::to_string(v.integer);
    case json::Value::Type::Real:
      return fmt::format("{}", v.real);
    case json::Value::Type::String:
      return "\"" + v.string + "\"";
    case json::Value::Type::Array: {
      std::string text;
      for (const json::Value& item : v.items) text += (text.empty() ? "" : ",") + compact(item);
      return "[" + text + "]";
    }
    case json::Value::Type::Object:
      break;
  }
  std::string text;
  for (const json::Member& m : v.members)
    text += (text.empty() ? "" : ",") + ("\"" + m.key + "\":" + compact(m.value));
  return "{" + text + "}";
}

std::string merged(const std::string& base, const std::string& patch, Diagnostics* diagnostics = nullptr) {
  Diagnostics own;
  const json::Value result = mergeDocuments(json::parse(base, "base.json"), json::parse(patch, "patch.json"),
                                            diagnostics ? *diagnostics : own);
  if (!diagnostics) {
    EXPECT_FALSE(own.hasErrors()) << own.format();
  }
  return compact(result);
}

TEST(Merge, ExamplesOfRfc7396) {
  EXPECT_EQ(merged(R"({"a":"b"})", R"({"a":"c"})"), R"({"a":"c"})");
  EXPECT_EQ(merged(R"({"a":"b"})", R"({"b":"c"})"), R"({"a":"b","b":"c"})");
  EXPECT_EQ(merged(R"({"a":"b"})", R"({"a":null})"), R"({})");
  EXPECT_EQ(merged(R"({"a":"b","b":"c"})", R"({"a":null})"), R"({"b":"c"})");
  EXPECT_EQ(merged(R"({"a":["b"]})", R"({"a":"c"})"), R"({"a":"c"})");
  EXPECT_EQ(merged(R"({"a":"c"})", R"({"a":["b"]})"), R"({"a":["b"]})");
  EXPECT_EQ(merged(R"({"a":{"b":"c"}})", R"({"a":{"b":"d","c":1}})"), R"({"a":{"b":"d","c":1}})");
  EXPECT_EQ(merged(R"({"a":[{"b":"c"}]})", R"({"a":[1]})"), R"({"a":[1]})");
  EXPECT_EQ(merged(R"({"a":{"b":1}})", R"({"a":2})"), R"({"a":2})");
  EXPECT_EQ(merged(R"({"a":2})", R"({"a":{"b":1}})"), R"({"a":{"b":1}})");
}

TEST(Merge, BaseKeysComeFirst) {
  EXPECT_EQ(merged(R"({"passes":{"z":{"type":"t"},"a":{"type":"t"}}})",
                   R"({"passes":{"n":{"type":"t"},"a":{"view":"v"}}})"),
            R"({"passes":{"z":{"type":"t"},"a":{"type":"t","view":"v"},"n":{"type":"t"}}})");
}

TEST(Merge, AnotherTypeReplacesThePassWhole) {
  const std::string base = R"({"passes":{"a":{"type":"s","params":{"x":1},"inputs":{"i":"b"}}}})";
  EXPECT_EQ(merged(base, R"({"passes":{"a":{"type":"t","params":{"y":2}}}})"),
            R"({"passes":{"a":{"type":"t","params":{"y":2}}}})");
  EXPECT_EQ(merged(base, R"({"passes":{"a":{"type":"s","params":{"y":2}}}})"),
            R"({"passes":{"a":{"type":"s","params":{"x":1,"y":2},"inputs":{"i":"b"}}}})");
  EXPECT_EQ(merged(base, R"({"passes":{"a":{"graph":"g.json"}}})"), R"({"passes":{"a":{"graph":"g.json"}}})");
  // This applies only under "passes".
  EXPECT_EQ(merged(R"({"inputs":{"a":{"type":"s","x":1}}})", R"({"inputs":{"a":{"type":"t"}}})"),
            R"({"inputs":{"a":{"type":"t","x":1}}})");
}

TEST(Merge, ANullThatRemovesNothingIsAnError) {
  Diagnostics d;
  EXPECT_EQ(merged(R"({"passes":{"deferred":1}})", "{\"passes\":{\n\"defered\":null}}", &d),
            R"({"passes":{"deferred":1}})");
  ASSERT_EQ(d.list().size(), 1u);
  EXPECT_EQ(d.list()[0].format(),
            "patch.json:2:11: error: `null` removes nothing: what this extends has no `defered` (at "
            "passes.defered)\n"
            "  -> did you mean `deferred`?");
}

TEST(Merge, PlacesPointIntoTheFileTheValueCameFrom) {
  Diagnostics d;
  const json::Value v = mergeDocuments(json::parse("{\"a\": 1, \"b\": 2}", "base.json"),
                                       json::parse("{\n\"b\": 3}", "patch.json"), d);
  EXPECT_EQ(*v.find("a")->where.file, "base.json");
  EXPECT_EQ(*v.find("b")->where.file, "patch.json");
  EXPECT_EQ(v.findMember("b")->keyWhere.line, 2);
}

// ---- Whole graphs -----------------------------------------------------------------------------------------

struct Loaded {
  Description description;
  Diagnostics messages;
  // "pass.port.member@previous"
  std::string wire(const WireDescription& w) const {
    std::string t =
        w.external ? "inputs." + description.externals[*w.external].name : description.passes[w.pass].name;
    if (!w.port.empty()) t += "." + std::string(w.port);
    if (!w.member.empty()) t += "." + std::string(w.member);
    return w.previous ? t + "@previous" : t;
  }
  std::vector<std::string> passes() const {
    std::vector<std::string> names;
    for (const PassDescription& p : description.passes) names.push_back(p.name);
    return names;
  }
  std::string input(const std::string& pass, const std::string& port) const {
    for (const PassDescription& p : description.passes)
      for (uint32_t i = 0; p.name == pass && i < p.inputCount; ++i)
        if (description.wires[p.firstInput + i].target() == port)
          return wire(description.wires[p.firstInput + i]);
    return "none";
  }
  std::string parameter(const std::string& pass, const std::string& name) const {
    for (const PassDescription& p : description.passes) {
      for (uint32_t i = 0; p.name == pass && i < p.parameterCount; ++i) {
        const ParameterDescription& v = description.parameters[p.firstParameter + i];
        if (v.given->key != name) continue;
        if (v.value->isString()) return "\"" + v.value->string + "\"";
        if (v.value->isBool()) return v.value->boolean ? "true" : "false";
        if (!v.value->isInt()) return fmt::format("{}", v.value->real);
        return std::to_string(v.value->integer);
      }
    }
    return "none";
  }
};

Loaded loadFrom(const TempFolder& folder, const std::string& file,
                const std::vector<Override>& overrides = {}) {
  Loaded l;
  l.description = load((folder.path() / file).string(), {overrides, {}}, l.messages);
  return l;
}

Loaded resolved(const std::string& text, const std::vector<Override>& overrides = {}) {
  Loaded l;
  l.description = loadText(text, "g.json", {overrides, {}}, l.messages);
  return l;
}

using Names = std::vector<std::string>;

TEST(Extends, ChainsAcrossFoldersAndKeepsTheBasesOrder) {
  TempFolder folder;
  folder.write(
      "base/one.json",
      R"({"description": "one", "parameters": {"n": 1}, "passes": {"a": {"type": "s", "params": {"x": "$n"}}, "b": {"type": "t"}}})");
  folder.write("two.json",
               R"({"extends": "base/one.json", "parameters": {"n": 2}, "passes": {"c": {"type": "u"}}})");
  folder.write(
      "three.json",
      R"({"extends": "two.json", "description": "three", "passes": {"b": null, "d": {"type": "v"}}})");
  const Loaded l = loadFrom(folder, "three.json");
  EXPECT_FALSE(l.messages.hasErrors()) << l.messages.format();
  EXPECT_EQ(l.passes(), (Names{"a", "c", "d"}));
  EXPECT_EQ(l.parameter("a", "x"), "2");
  EXPECT_EQ(l.description.description, "three");
  EXPECT_EQ(l.description.name, "three");
}

TEST(Extends, CirclesAndMissingFiles) {
  TempFolder folder;
  folder.write("a.json", R"({"extends": "b.json"})");
  folder.write("b.json", R"({"extends": "a.json"})");
  folder.write("self.json", R"({"extends": "self.json"})");
  folder.write("lost.json", "{\n  \"extends\": \"nowhere.json\"}");
  const auto message = [&](const char* file) {
    try {
      loadFrom(folder, file);
      return std::string();
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(message("a.json"), HasSubstr("extends itself"));
  EXPECT_THAT(message("self.json"), HasSubstr("self.json:1:13: error: `self.json` extends itself"));
  EXPECT_THAT(message("lost.json"), HasSubstr("lost.json:2:14: error: no graph file `nowhere.json`"));
}

TEST(Extends, ErrorsOfTheBaseAreReportedInTheBase) {
  TempFolder folder;
  folder.write("base.json", "{\"passes\": {\n\"a\": {\"type\": \"s\", \"colour\": 1}}}");
  folder.write("top.json", R"({"extends": "base.json", "passes": {"b": {"type": "s", "color": 1}}})");
  const Loaded l = loadFrom(folder, "top.json");
  EXPECT_THAT(l.messages.format(), HasSubstr("base.json:2:20: error: unknown key `colour`"));
  EXPECT_THAT(l.messages.format(), HasSubstr("top.json:1:56: error: unknown key `color`"));
}

TEST(Load, FindsGraphsByNameInSearchPaths) {
  TempFolder folder;
  folder.write("graphs/ir_1000.json", R"({"passes": {"a": {"type": "s"}}})");
  Diagnostics d;
  const LoadOptions options{{}, {folder.path() / "elsewhere", folder.path() / "graphs"}};
  EXPECT_EQ(load("ir_1000", options, d).name, "ir_1000");
  EXPECT_EQ(load("ir_1000.json", options, d).name, "ir_1000");
  EXPECT_EQ(load((folder.path() / "graphs/ir_1000.json").string(), {}, d).name, "ir_1000");
  EXPECT_EQ(load((folder.path() / "graphs/ir_1000").string(), {}, d).name, "ir_1000");
  try {
    load("ir_100", options, d);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_THAT(e.what(), HasSubstr("no graph `ir_100`"));
    EXPECT_THAT(e.what(), HasSubstr("did you mean `ir_1000`?"));
  }
}

TEST(Parameters, EveryTypeIsPutIn) {
  const Loaded l = resolved(R"({"parameters": {"i": 3, "r": 0.5, "b": true, "t": "text"},
    "passes": {"a": {"type": "s", "params": {"i": "$i", "r": "$r", "b": "$b", "t": "$t", "own": 7, "cash": "$$5"}}}})");
  EXPECT_FALSE(l.messages.hasErrors()) << l.messages.format();
  EXPECT_EQ(l.parameter("a", "i"), "3");
  EXPECT_EQ(l.parameter("a", "r"), "0.5");
  EXPECT_EQ(l.parameter("a", "b"), "true");
  EXPECT_EQ(l.parameter("a", "t"), "\"text\"");
  EXPECT_EQ(l.parameter("a", "own"), "7");
  EXPECT_EQ(l.parameter("a", "cash"), "\"$5\"");
}

TEST(Parameters, UnusedOnesAreWarnedAbout) {
  const Loaded l = resolved(
      "{\"parameters\": {\n\"used\": 1, \"unused\": 2}, \"passes\": {\"a\": {\"type\": \"s\", \"params\": "
      "{\"x\": \"$used\"}}}}");
  ASSERT_EQ(l.messages.list().size(), 1u) << l.messages.format();
  EXPECT_EQ(l.messages.list()[0].format(),
            "g.json:2:12: warning: nothing uses the graph parameter `unused` (at parameters.unused)");
}

const char* kGraph = R"({"parameters": {"n": 3, "r": 0.5, "b": true, "t": "text"},
    "passes": {"a": {"type": "s", "params": {"i": "$n", "r": "$r", "b": "$b", "t": "$t", "own": 7}}}})";

TEST(Overrides, AreReadAsTheTypeTheyReplace) {
  const Loaded l = resolved(
      kGraph, {{"n", "500"}, {"r", "2"}, {"b", "false"}, {"t", "12"}, {"a.own", "9"}, {"a.new", "x"}});
  EXPECT_FALSE(l.messages.hasErrors()) << l.messages.format();
  EXPECT_EQ(l.parameter("a", "i"), "500");
  EXPECT_EQ(l.parameter("a", "r"), "2");
  EXPECT_EQ(l.parameter("a", "b"), "false");
  EXPECT_EQ(l.parameter("a", "t"), "\"12\"");
  EXPECT_EQ(l.parameter("a", "own"), "\"9\"");  // bind knows its type
  EXPECT_EQ(l.parameter("a", "new"), "\"x\"");
}

TEST(Overrides, TheLastOneWins) {
  EXPECT_EQ(resolved(kGraph, {{"n", "1"}, {"n", "2"}}).parameter("a", "i"), "2");
}

TEST(Overrides, UnknownOnesAreLeftToBind) {
  const Loaded l = resolved(kGraph, {{"m", "1"}, {"n", "1"}, {"aa.own", "1"}});
  EXPECT_FALSE(l.messages.hasErrors()) << l.messages.format();
  ASSERT_EQ(l.description.unusedOverrides.size(), 2u);
  EXPECT_EQ(l.description.unusedOverrides[0].typed(), "--set m=1");
  EXPECT_EQ(l.description.unusedOverrides[1].typed(), "--set aa.own=1");
}

TEST(Overrides, WhatCannotBeReadStaysATextForBind) {
  for (const char* text :
       {"many", "inf", "5x", "0500", "-0500", "00", "+500", "0x1f4", "NaN", "nan", "five", ""})
    EXPECT_EQ(resolved(kGraph, {{"n", text}}).parameter("a", "i"), fmt::format("\"{}\"", text));
  EXPECT_EQ(resolved(kGraph, {{"b", "yes"}}).parameter("a", "b"), "\"yes\"");
  EXPECT_THROW(parseOverride("novalue"), Error);
  EXPECT_THROW(parseOverride("=5"), Error);
  EXPECT_EQ(parseOverride("a.b=c=d").value, "c=d");
  EXPECT_EQ(parseOverride("a=").value, "");
}

// ---- Sub-graphs -------------------------------------------------------------------------------------------

class SubGraphs : public testing::Test {
 protected:
  TempFolder folder;
  void SetUp() override {
    folder.write("eye.json", R"({
      "parameters": {"radius": 0.25, "n": 10},
      "inputs": {"vpls": {"doc": "lights"}, "mask": {"optional": true}},
      "passes": {
        "gbuffer": {"type": "draw"},
        "deferred": {"type": "shade", "inputs": {"gbuffer": "gbuffer", "vpls": "inputs.vpls", "mask": "inputs.mask", "old": "deferred.image@previous"},
                     "params": {"radius": "$radius", "n": "$n"}},
        "tonemap": {"type": "tone", "inputs": {"image": "deferred.image"}, "view": "main"}},
      "outputs": {"image": "tonemap.ldr", "position": "gbuffer.gbuffer.position"}})");
    folder.write("stereo.json", R"({
      "parameters": {"r": 0.5},
      "passes": {
        "emit": {"type": "emit"},
        "left": {"graph": "eye.json", "view": "left", "parameters": {"radius": "$r"}, "inputs": {"vpls": "emit.vpls"}},
        "right": {"graph": "eye.json", "view": "right", "inputs": {"vpls": "emit", "mask": "left.position"}},
        "join": {"type": "join", "inputs": {"a": "left.image", "b": "right.image@previous", "c": "left/deferred.image"}}},
      "outputs": {"image": "join"}})");
  }
};

TEST_F(SubGraphs, AreInstancedUnderTheirPrefix) {
  const Loaded l = loadFrom(folder, "stereo.json");
  EXPECT_FALSE(l.messages.hasErrors()) << l.messages.format();
  EXPECT_EQ(l.passes(), (Names{"emit", "left/gbuffer", "left/deferred", "left/tonemap", "right/gbuffer",
                               "right/deferred", "right/tonemap", "join"}));
  EXPECT_EQ(l.input("left/deferred", "gbuffer"), "left/gbuffer");
  EXPECT_EQ(l.input("right/deferred", "gbuffer"), "right/gbuffer");
  EXPECT_EQ(l.input("left/deferred", "vpls"), "emit.vpls");
  EXPECT_EQ(l.input("right/deferred", "vpls"), "emit");
  EXPECT_EQ(l.input("left/deferred", "old"), "left/deferred.image@previous");
  EXPECT_EQ(l.input("left/deferred", "mask"), "none");  // optional and open
  EXPECT_EQ(l.input("right/deferred", "mask"), "left/gbuffer.gbuffer.position");
  EXPECT_EQ(l.input("join", "a"), "left/tonemap.ldr");
  EXPECT_EQ(l.input("join", "b"), "right/tonemap.ldr@previous");
  EXPECT_EQ(l.input("join", "c"), "left/deferred.image");
}

TEST_F(SubGraphs, HaveTheirOwnParametersAndView) {
  const Loaded l = loadFrom(folder, "stereo.json");
  EXPECT_EQ(l.parameter("left/deferred", "radius"), "0.5");
  EXPECT_EQ(l.parameter("right/deferred", "radius"), "0.25");
  auto view = [&](size_t i) { return l.description.passes[i].view.value_or("-"); };
  EXPECT_EQ(view(0), "-");
  EXPECT_EQ(view(1), "left");
  EXPECT_EQ(view(3), "main");  // its own
  EXPECT_EQ(view(4), "right");
}

TEST_F(SubGraphs, UnusedParametersAreReportedWhereTheyAreDeclared) {
  folder.write("idle.json", "{\n  \"parameters\": {\"idle\": 1},\n  \"passes\": {\"a\": {\"type\": \"s\"}}}");
  folder.write("given.json", R"({"parameters": {"r": 2},
    "passes": {"left": {"graph": "idle.json", "parameters": {"idle": "$r"}}}})");
  EXPECT_THAT(loadFrom(folder, "given.json").messages.format(),
              HasSubstr("idle.json:2:18: warning: nothing uses the graph parameter `idle`"));
}

TEST_F(SubGraphs, CanBeOverridden) {
  const Loaded l =
      loadFrom(folder, "stereo.json", {{"left.n", "20"}, {"right/deferred.radius", "0.1"}, {"r", "0.75"}});
  EXPECT_FALSE(l.messages.hasErrors()) << l.messages.format();
  EXPECT_EQ(l.parameter("left/deferred", "n"), "20");
  EXPECT_EQ(l.parameter("right/deferred", "n"), "10");
  EXPECT_EQ(l.parameter("right/deferred", "radius"), "\"0.1\"");
  EXPECT_EQ(l.parameter("left/deferred", "radius"), "0.75");
}

TEST_F(SubGraphs, MistakesAtTheInstance) {
  folder.write("bad.json", R"({"passes": {
"emit": {"type": "emit"},
"eye": {"graph": "eye.json", "parameters": {"radios": 1, "n": "text"}, "inputs": {"vpl": "emit"}},
"gone": {"graph": "ear.json"},
"both": {"graph": "eye.json", "type": "s"},
"user": {"type": "s", "inputs": {"a": "eye.imag", "b": "eye", "c": "eye/deffered"}}},
"outputs": {"o": "eye.image"}})");
  const std::string text = loadFrom(folder, "bad.json").messages.format();
  EXPECT_THAT(text, HasSubstr("bad.json:3:45: error: the sub-graph has no parameter `radios` (at "
                              "passes.eye.parameters.radios)\n  -> did you mean `radius`?"));
  EXPECT_THAT(
      text,
      HasSubstr(
          "bad.json:3:63: error: expected a number, as the sub-graph's default, found the text \"text\""));
  EXPECT_THAT(text, HasSubstr("bad.json:3:83: error: the sub-graph has no input `vpl` (at "
                              "passes.eye.inputs.vpl)\n  -> did you mean `vpls`?"));
  EXPECT_THAT(text, HasSubstr("bad.json:3:1: error: input `vpls` of the sub-graph `eye` is not wired"));
  EXPECT_THAT(text, HasSubstr("bad.json:4:19: error: no graph file `ear.json`"));
  EXPECT_THAT(text, HasSubstr("bad.json:5:19: error: a pass has a `type` or a `graph`, not both"));
  EXPECT_THAT(text, HasSubstr("bad.json:6:39: error: the sub-graph `eye` has no output `imag`"));
  EXPECT_THAT(text, HasSubstr("bad.json:6:56: error: the sub-graph `eye` has 2 outputs: name one"));
  EXPECT_THAT(text, HasSubstr("bad.json:6:68: error: no pass `eye/deffered` (at passes.user.inputs.c)\n  -> "
                              "did you mean `eye/deferred`?"));
}

TEST_F(SubGraphs, CannotContainThemselves) {
  folder.write("loop.json", R"({"passes": {"again": {"graph": "loop.json"}}})");
  EXPECT_THAT(loadFrom(folder, "loop.json").messages.format(), HasSubstr("`loop.json` contains itself"));
}

TEST_F(SubGraphs, WiresInACircleThroughSubGraphsEnd) {
  folder.write("through.json", R"({"inputs": {"i": {}}, "outputs": {"o": "inputs.i"}})");
  folder.write("circle.json", R"({"passes": {"a": {"graph": "through.json", "inputs": {"i": "b.o"}},
    "b": {"graph": "through.json", "inputs": {"i": "a.o"}}, "c": {"type": "s", "inputs": {"x": "a.o"}}}})");
  EXPECT_THAT(loadFrom(folder, "circle.json").messages.format(), HasSubstr("runs in a circle"));
}

TEST_F(SubGraphs, NestAndExtend) {
  folder.write(
      "inner.json",
      R"({"parameters": {"k": 1}, "inputs": {"i": {}}, "passes": {"p": {"type": "s", "inputs": {"x": "inputs.i"}, "params": {"k": "$k"}}}, "outputs": {"o": "p"}})");
  folder.write(
      "inner2.json",
      R"({"extends": "inner.json", "passes": {"q": {"type": "t", "inputs": {"x": "p.out@previous"}}}, "outputs": {"o": "q"}})");
  folder.write(
      "outer.json",
      R"({"parameters": {"k": 5}, "inputs": {"j": {}}, "passes": {"in": {"graph": "inner2.json", "parameters": {"k": "$k"}, "inputs": {"i": "inputs.j"}}}, "outputs": {"o": "in"}})");
  folder.write(
      "top.json",
      R"({"passes": {"s": {"type": "s"}, "out": {"graph": "outer.json", "parameters": {"k": 7}, "inputs": {"j": "s.image"}}, "e": {"type": "e", "inputs": {"x": "out.o"}}}, "outputs": {"o": "e"}})");
  const Loaded l = loadFrom(folder, "top.json");
  EXPECT_FALSE(l.messages.hasErrors()) << l.messages.format();
  EXPECT_EQ(l.passes(), (Names{"s", "out/in/p", "out/in/q", "e"}));
  EXPECT_EQ(l.input("out/in/p", "x"), "s.image");
  EXPECT_EQ(l.input("out/in/q", "x"), "out/in/p.out@previous");
  EXPECT_EQ(l.input("e", "x"), "out/in/q");
  EXPECT_EQ(l.parameter("out/in/p", "k"), "7");
}

TEST(Inputs, OfAWholeGraphDescribeTheCallersMemory) {
  const Loaded l = resolved(R"({"parameters": {"n": 12}, "inputs": {
      "radiance": {"doc": "light", "format": "rgba32f", "width": 8, "height": 4},
      "maps": {"format": "d32f", "width": 8, "height": 8, "layers": "$n"},
      "volume": {"format": "r32ui", "width": 4, "height": 4, "depth": 4, "mips": 2},
      "vpls": {"element": "Vpl", "stride": 64, "count": 1000},
      "gbuffer": {"bundle": "gbuffer", "members": {"position": {"format": "rgba32f"}, "depth": {"format": "d32f"}}}},
    "passes": {"a": {"type": "s", "inputs": {"a": "inputs.radiance", "b": "inputs.maps", "c": "inputs.volume", "d": "inputs.vpls", "e": "inputs.gbuffer.depth"}}}})");
  EXPECT_FALSE(l.messages.hasErrors()) << l.messages.format();
  const std::vector<ExternalDescription>& e = l.description.externals;
  ASSERT_EQ(e.size(), 5u);
  EXPECT_EQ(e[0].resources[0].format, VK_FORMAT_R32G32B32A32_SFLOAT);
  EXPECT_EQ(e[0].resources[0].height, 4u);
  EXPECT_TRUE(e[1].resources[0].array);
  EXPECT_EQ(e[1].resources[0].layers, 12u);
  EXPECT_TRUE(e[2].resources[0].volume);
  EXPECT_EQ(e[3].resources[0].count, 1000u);
  EXPECT_EQ(e[3].resources[0].element, "Vpl");
  EXPECT_EQ(e[4].resources.size(), 2u);
  EXPECT_EQ(l.input("a", "e"), "inputs.gbuffer.depth");
}

TEST(Resolve, TooManyPasses) {
  std::string text = "{\"passes\": {";
  for (size_t i = 0; i <= kMaxPasses; ++i)
    text += fmt::format("{}\"p{}\": {{\"type\": \"s\"}}", i ? "," : "", i);
  EXPECT_THAT([&] { resolved(text + "}}"); },
              testing::Throws<Error>(testing::Property(&Error::what, HasSubstr("more than 10000 passes"))));
}

}  // namespace
}  // namespace fovea::graph::test
