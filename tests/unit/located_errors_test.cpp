// One test for each kind of mistake: the message gives the exact position (file, line, column, path in the document),
// what was expected, and the nearest valid name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

// All errors of a graph as they would be printed.
std::vector<std::string> errorsOf(const std::string& text, const std::vector<Override>& overrides = {}) {
  const auto registry = basicRegistry();
  Diagnostics messages;
  try {
    bind(loadText(text, "g.json", {overrides, {}}, messages), basicEnvironment(*registry), messages);
    return {};
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    std::vector<std::string> lines;
    for (const Diagnostic& d : e.diagnostics())
      if (d.severity == Severity::Error) lines.push_back(d.format());
    return lines;
  }
}

struct Mistake {
  const char* name;
  const char* graph;
  const char* message;  // the whole of it
};

class LocatedErrors : public testing::TestWithParam<Mistake> {};

TEST_P(LocatedErrors, NamePlaceExpectationAndRemedy) {
  EXPECT_THAT(errorsOf(GetParam().graph), testing::ElementsAre(std::string(GetParam().message)));
}

const Mistake kMistakes[] = {
    // ---- the document
    {"NotJson", "{\n  \"passes\": {,}\n}",
     "g.json:2:14: error: not valid JSON: syntax error while parsing object key - unexpected ','; expected "
     "string literal"},
    {"DuplicatePass", R"({"passes": {"a": {"type": "source"},
  "a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:2:3: error: the key \"a\" occurs twice in this object\n  -> remove or rename one of them"},
    {"NotAnObject", "[1]", "g.json:1:1: error: a graph is an object, this is an array"},
    {"UnknownKey", R"({"passes": {"a": {"type": "source"}},
  "output": {"o": "a"}, "outputs": {"o": "a"}})",
     "g.json:2:3: error: unknown key `output` (at output)\n  -> did you mean `outputs`?"},
    {"UnknownKeyFarFromAny", R"({"passes": {"a": {"type": "source"}}, "x": 1, "outputs": {"o": "a"}})",
     "g.json:1:39: error: unknown key `x` (at x)\n  -> known here: $schema, extends, version, description, "
     "parameters, "
     "inputs, view, outputs, passes"},
    {"UnknownKeyOfAPass", R"({"passes": {"a": {"type": "source", "parms": {}}}, "outputs": {"o": "a"}})",
     "g.json:1:37: error: unknown key `parms` (at passes.a.parms)\n  -> did you mean `params`?"},
    {"PassesIsAList", R"({"passes": ["a"], "outputs": {}})",
     "g.json:1:12: error: `passes`: expected an object, found an array (at passes)"},
    {"PassIsAText", R"({"passes": {"a": "source"}})",
     "g.json:1:18: error: expected an object, found the text \"source\" (at passes.a)"},
    {"DescriptionIsANumber",
     R"({"description": 5, "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:17: error: `description`: expected a text, found the number 5 (at description)"},
    {"ExtendsIsANumber", R"({"extends": 5, "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:13: error: expected a file name, found the number 5 (at extends)"},
    {"ExtendsNothing",
     R"({"extends": "nothing.json", "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:13: error: no graph file `nothing.json` (at extends)\n  -> it is looked up beside g.json and "
     "in the search paths"},
    {"NoOutputs", R"({"passes": {"a": {"type": "source"}}})",
     "g.json:1:1: error: the graph has no outputs, so nothing would run (at outputs)\n  -> add \"outputs\": "
     "{\"image\": \"pass.port\"}"},
    {"BadPassName",
     R"({"passes": {"a.b": {"type": "source"}, "c": {"type": "source"}}, "outputs": {"o": "c"}})",
     "g.json:1:13: error: `a.b` is no name for a pass (at passes.a.b)\n  -> letters, digits, _ and -; "
     "`inputs` means the graph's own inputs, `view` what belongs to the frame"},
    {"NullWithoutABase", R"({"passes": {"a": {"type": "source"}, "b": null}, "outputs": {"o": "a"}})",
     "g.json:1:43: error: expected an object, found null (at passes.b)"},
    // ---- parameters
    {"UnknownGraphParameter",
     R"({"parameters": {"vpl_count": 1}, "passes": {"a": {"type": "source", "params": {
  "count": "$vpl_cuont", "radius": "$vpl_count"}}}, "outputs": {"o": "a"}})",
     "g.json:2:12: error: no graph parameter `$vpl_cuont` (at passes.a.params.count)\n  -> did you mean "
     "`$vpl_count`?"},
    {"GraphParameterIsAList",
     R"({"parameters": {"n": [1]}, "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:22: error: expected true, false, a number or a text, found an array (at parameters.n)"},
    {"GraphParameterOfAnother",
     R"({"parameters": {"n": "$m"}, "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:22: error: a parameter's default cannot be another parameter (at parameters.n)\n  -> write "
     "the value itself"},
    {"UnknownParameter",
     R"({"passes": {"a": {"type": "source", "params": {"radios": 0.5}}}, "outputs": {"o": "a"}})",
     "g.json:1:48: error: `source` has no parameter `radios` (at passes.a.params.radios)\n  -> did you mean "
     "`radius`?"},
    {"UnknownParameterOfAPassWithNone",
     R"({"passes": {"a": {"type": "source"}, "b": {"type": "filter", "inputs": {"image": "a"}, "params": {"x": 1}}}, "outputs": {"o": "b"}})",
     "g.json:1:99: error: `filter` has no parameter `x` (at passes.b.params.x)\n  -> it has none"},
    {"ParameterOutOfRange",
     R"({"passes": {"a": {"type": "source", "params": {"count": 11}}}, "outputs": {"o": "a"}})",
     "g.json:1:57: error: parameter `count`: expected a whole number from 1 to 10, found 11 (at "
     "passes.a.params.count)"},
    {"ParameterBelowRange",
     R"({"passes": {"a": {"type": "source", "params": {"radius": -0.5}}}, "outputs": {"o": "a"}})",
     "g.json:1:58: error: parameter `radius`: expected a number from 0 to 1, found -0.5 (at "
     "passes.a.params.radius)"},
    {"RealForWhole",
     R"({"passes": {"a": {"type": "source", "params": {"count": 2.5}}}, "outputs": {"o": "a"}})",
     "g.json:1:57: error: parameter `count`: expected a whole number from 1 to 10, found 2.5 (at "
     "passes.a.params.count)"},
    {"TextForNumber",
     R"({"passes": {"a": {"type": "source", "params": {"radius": "big"}}}, "outputs": {"o": "a"}})",
     "g.json:1:58: error: parameter `radius`: expected a number from 0 to 1, found `big` (at "
     "passes.a.params.radius)"},
    {"NumberForFlag",
     R"({"passes": {"a": {"type": "source", "params": {"fast": 1}}}, "outputs": {"o": "a"}})",
     "g.json:1:56: error: parameter `fast`: expected true or false, found 1 (at passes.a.params.fast)"},
    {"UnknownChoice",
     R"({"passes": {"a": {"type": "source", "params": {"kernel": "disk"}}}, "outputs": {"o": "a"}})",
     "g.json:1:58: error: parameter `kernel`: expected one of disc, clamp, found `disk` (at "
     "passes.a.params.kernel)\n  -> did you mean `disc`?"},
    {"ListForText",
     R"({"passes": {"a": {"type": "source", "params": {"label": []}}}, "outputs": {"o": "a"}})",
     "g.json:1:57: error: expected true, false, a number or a text, found an array (at "
     "passes.a.params.label)"},
    {"GraphParameterOfTheWrongType",
     R"({"parameters": {"n": 0.5}, "passes": {"a": {"type": "source", "params": {"count": "$n"}}}, "outputs": {"o": "a"}})",
     "g.json:1:22: error: parameter `n`: expected a whole number from 1 to 10, found 0.5 (at "
     "parameters.n)"},
    {"GraphParameterThatOthersTake",
     R"({"parameters": {"n": 0.5}, "passes": {"a": {"type": "source", "params": {"radius": "$n", "kernel": "$n"}}}, "outputs": {"o": "a"}})",
     "g.json:1:100: error: parameter `kernel`: expected one of disc, clamp, found 0.5 (at "
     "passes.a.params.kernel)"},
    {"GraphParameterOutOfTheRangeOfOneOfSeveral",
     R"({"parameters": {"n": 50}, "passes": {"a": {"type": "source", "params": {"count": "$n"}}, "e": {"type": "emit", "params": {"vpl_count": "$n"}}}, "outputs": {"o": "a", "e": "e"}})",
     "g.json:1:22: error: parameter `n`: expected a whole number from 1 to 10, found 50 (at parameters.n)"},
    // ---- passes
    {"UnknownType",
     R"({"passes": {"a": {"type": "sourse"}, "b": {"type": "filter", "inputs": {"image": "a"}}}, "outputs": {"o": "b"}})",
     "g.json:1:27: error: no pass type `sourse` (at passes.a.type)\n  -> did you mean `source`?"},
    {"MissingType", R"({"passes": {"a": {}}, "outputs": {"o": "a"}})",
     "g.json:1:18: error: `type` is missing (at passes.a)"},
    {"TypeIsANumber", R"({"passes": {"a": {"type": 1}}, "outputs": {"o": "a"}})",
     "g.json:1:27: error: expected the name of a pass type, found the number 1 (at passes.a.type)"},
    {"UnknownView", R"({"passes": {"a": {"type": "draw", "view": "centre"}}, "outputs": {"o": "a"}})",
     "g.json:1:43: error: no view `centre` (at passes.a.view)\n  -> there is: main, left, right"},
    {"ViewForAPassWithout", R"({"passes": {"e": {"type": "emit", "view": "left"}}, "outputs": {"o": "e"}})",
     "g.json:1:43: error: `emit` passes do not look through a camera (at passes.e.view)\n  -> remove `view`"},
    {"ViewIsANumber", R"({"passes": {"a": {"type": "draw", "view": 1}}, "outputs": {"o": "a"}})",
     "g.json:1:43: error: expected the name of a view, found the number 1 (at passes.a.view)"},
    // ---- wires
    {"UnknownPass", R"({"passes": {"gbuffer": {"type": "source"}, "f": {"type": "filter", "inputs": {
    "image": "gbufer.image"}}}, "outputs": {"o": "f"}})",
     "g.json:2:14: error: no pass `gbufer` (at passes.f.inputs.image)\n  -> did you mean `gbuffer`?"},
    {"UnknownPort",
     R"({"passes": {"a": {"type": "source"}, "f": {"type": "filter", "inputs": {"image": "a.imag"}}}, "outputs": {"o": "f"}})",
     "g.json:1:82: error: no output `a.imag` (at passes.f.inputs.image)\n  -> did you mean `a.image`?"},
    {"PortIsAnInput",
     R"({"passes": {"a": {"type": "source"}, "b": {"type": "blend", "inputs": {"a": "a"}}, "f": {"type": "filter", "inputs": {"image": "b.b"}}}, "outputs": {"o": "f"}})",
     "g.json:1:128: error: no output `b.b` (at passes.f.inputs.image)\n  -> there is: b.image"},
    {"PortIsScratch",
     R"({"passes": {"e": {"type": "emit"}, "d": {"type": "draw"}, "s": {"type": "shade", "inputs": {"gbuffer": "d", "vpls": "e.paths"}}}, "outputs": {"o": "s"}})",
     "g.json:1:117: error: no output `e.paths` (at passes.s.inputs.vpls)\n  -> there is: e.vpls"},
    {"UnknownMember",
     R"({"passes": {"d": {"type": "draw"}, "f": {"type": "filter", "inputs": {"image": "d.gbuffer.norml"}}}, "outputs": {"o": "f"}})",
     "g.json:1:80: error: no output `d.gbuffer.norml` (at passes.f.inputs.image)\n  -> did you mean "
     "`d.gbuffer.normal`?"},
    {"NoOutputsToWire",
     R"({"passes": {"a": {"type": "source"}, "l": {"type": "log", "inputs": {"image": "a"}}, "f": {"type": "filter", "inputs": {"image": "l"}}}, "outputs": {"o": "f"}})",
     "g.json:1:130: error: `l` has 0 outputs: name one (at passes.f.inputs.image)\n  -> `l` has no outputs"},
    {"WireIsANumber",
     R"({"passes": {"f": {"type": "filter", "inputs": {"image": 1}}}, "outputs": {"o": "f"}})",
     "g.json:1:57: error: expected a wire such as \"pass.port\", found the number 1 (at "
     "passes.f.inputs.image)"},
    {"WireIsNoWire",
     R"({"passes": {"a": {"type": "source"}, "f": {"type": "filter", "inputs": {"image": "a..image"}}}, "outputs": {"o": "f"}})",
     "g.json:1:82: error: `a..image` is no wire (at passes.f.inputs.image)\n"
     "  -> write pass.port, pass, or pass.port.member; @previous after it means last frame's value"},
    {"WrongSuffix",
     R"({"passes": {"a": {"type": "source"}, "f": {"type": "filter", "inputs": {"image": "a@last"}}}, "outputs": {"o": "f"}})",
     "g.json:1:82: error: `a@last`: only `@previous` may follow a port (at passes.f.inputs.image)"},
    {"UnknownInput",
     R"({"passes": {"a": {"type": "source"}, "f": {"type": "filter", "inputs": {"image": "a", "imge": "a"}}}, "outputs": {"o": "f"}})",
     "g.json:1:87: error: `filter` has no input `imge` (at passes.f.inputs.imge)\n  -> did you mean "
     "`image`?"},
    {"InputIsAnOutput",
     R"({"passes": {"a": {"type": "source"}, "f": {"type": "filter", "inputs": {"image": "a", "image_out": "a"}}}, "outputs": {"o": "f"}})",
     "g.json:1:87: error: `image_out` is an output of `filter`, not an input (at "
     "passes.f.inputs.image_out)\n  -> it has: image"},
    {"MissingInput", R"({"passes": {"a": {"type": "source"},
  "f": {"type": "filter"}}, "outputs": {"o": "f"}})",
     "g.json:2:3: error: `f`: the input `image` (an image of rgba16f) is not wired (at passes.f.inputs)\n  "
     "-> these would fit: a.image"},
    {"MissingInputWithoutACandidate", R"({"passes": {"m": {"type": "atlas"}}, "outputs": {"o": "m"}})",
     "g.json:1:13: error: `m`: the input `vpls` (a buffer of Vpl (64 bytes each)) is not wired (at "
     "passes.m.inputs)\n  -> no other pass of the graph makes one"},
    {"WrongFormat",
     R"({"passes": {"d": {"type": "draw"}, "f": {"type": "filter", "inputs": {"image": "d.depth"}}}, "outputs": {"o": "f"}})",
     "g.json:1:80: error: `image` wants an image of rgba16f, but `d.depth` is an image of d32f (at "
     "passes.f.inputs.image)"},
    {"BufferForImage",
     R"({"passes": {"e": {"type": "emit"}, "f": {"type": "filter", "inputs": {"image": "e"}}}, "outputs": {"o": "f"}})",
     "g.json:1:80: error: `image` wants an image of rgba16f, but `e` is a buffer of Vpl (64 bytes each) (at "
     "passes.f.inputs.image)"},
    {"ArrayForImage",
     R"({"inputs": {"i": {"format": "rgba16f", "layers": 2}}, "passes": {"f": {"type": "filter", "inputs": {"image": "inputs.i"}}}, "outputs": {"o": "f"}})",
     "g.json:1:110: error: `image` wants an image of rgba16f, but `inputs.i` is an image array of rgba16f "
     "(at passes.f.inputs.image)"},
    {"BundleForImage",
     R"({"passes": {"d": {"type": "draw"}, "f": {"type": "filter", "inputs": {"image": "d"}}}, "outputs": {"o": "f"}})",
     "g.json:1:80: error: `image` wants an image of rgba16f, but `d` is a bundle `gbuffer` (at "
     "passes.f.inputs.image)\n"
     "  -> wire a member of it, such as `d.normal`"},
    {"ImageForBundle",
     R"({"passes": {"a": {"type": "source"}, "s": {"type": "shade", "inputs": {"gbuffer": "a"}}}, "outputs": {"o": "s"}})",
     "g.json:1:83: error: `gbuffer` wants a bundle `gbuffer`, but `a` is an image of rgba16f (at "
     "passes.s.inputs.gbuffer)"},
    {"BundleLacksAMember",
     R"({"inputs": {"g": {"bundle": "gbuffer", "members": {"position": {"format": "rgba32f"}}}}, "passes": {"s": {"type": "shade", "inputs": {"gbuffer": "inputs.g"}}}, "outputs": {"o": "s"}})",
     "g.json:1:146: error: `gbuffer` wants a bundle `gbuffer`, but `inputs.g` is a bundle `gbuffer`: it "
     "lacks the member `depth` (at passes.s.inputs.gbuffer)"},
    {"BundleMemberOfAnotherFormat",
     R"({"inputs": {"g": {"bundle": "gbuffer", "members": {"position": {"format": "rgba16f"}, "depth": {"format": "d32f"}}}}, "passes": {"s": {"type": "shade", "inputs": {"gbuffer": "inputs.g"}}}, "outputs": {"o": "s"}})",
     "g.json:1:175: error: `gbuffer` wants a bundle `gbuffer`, but `inputs.g` is a bundle `gbuffer`: its "
     "member `position` is an image of rgba16f (at passes.s.inputs.gbuffer)"},
    {"Cycle", R"({"passes": {"a": {"type": "filter", "inputs": {"image": "c"}},
  "b": {"type": "filter", "inputs": {"image": "a"}},
  "c": {"type": "filter", "inputs": {"image": "b"}}}, "outputs": {"o": "c"}})",
     "g.json:1:57: error: these passes wait for each other: a <- c <- b <- a (at passes.a.inputs.image)\n"
     "  -> one of these wires must read last frame's value: append @previous"},
    {"SelfCycle", R"({"passes": {"a": {"type": "filter", "inputs": {"image": "a"}}}, "outputs": {"o": "a"}})",
     "g.json:1:57: error: these passes wait for each other: a <- a (at passes.a.inputs.image)\n"
     "  -> one of these wires must read last frame's value: append @previous"},
    {"CycleThroughAnUpdateInPlace",
     R"({"passes": {"a": {"type": "filter", "inputs": {"image": "u"}}, "u": {"type": "update", "inputs": {"image": "a"}}}, "outputs": {"o": "a"}})",
     "g.json:1:57: error: these passes wait for each other: a <- u <- a (at passes.a.inputs.image)\n"
     "  -> one of these wires must read last frame's value: append @previous"},
    // ---- history and updates in place
    {"HistoryOfAnInput",
     R"({"inputs": {"i": {"format": "rgba16f"}}, "passes": {"f": {"type": "filter", "inputs": {"image": "inputs.i@previous"}}}, "outputs": {"o": "f"}})",
     "g.json:1:97: error: an input of the graph has no history (at passes.f.inputs.image)\n  -> wire it "
     "without `@previous`"},
    {"HistoryOfSomethingKept",
     R"({"passes": {"a": {"type": "source"}, "k": {"type": "keep", "inputs": {"image": "a"}}, "f": {"type": "filter", "inputs": {"image": "k@previous"}}}, "outputs": {"o": "f"}})",
     "g.json:1:131: error: `k.sum` is kept and updated in place, so last frame's value is gone (at "
     "passes.f.inputs.image)\n"
     "  -> wire it without `@previous`, or make its pass declare it without keep()"},
    {"HistoryOfAnOldVersion",
     R"({"passes": {"a": {"type": "source"}, "u": {"type": "update", "inputs": {"image": "a"}}, "f": {"type": "blend", "inputs": {"a": "u", "b": "a@previous"}}}, "outputs": {"o": "f"}})",
     "g.json:1:138: error: `a@previous` is updated in place later in the frame (at passes.f.inputs.b)\n"
     "  -> `@previous` holds the last update: wire the pass that makes it"},
    {"UpdateOfLastFramesValue",
     R"({"passes": {"a": {"type": "source"}, "u": {"type": "update", "inputs": {"image": "a@previous"}}}, "outputs": {"o": "a"}})",
     "g.json:1:82: error: `image` is updated in place, last frame's value cannot be (at "
     "passes.u.inputs.image)\n"
     "  -> wire it without `@previous`"},
    {"TwoUpdatesOfOneVersion",
     R"({"passes": {"a": {"type": "source"}, "u": {"type": "update", "inputs": {"image": "a"}},
  "v": {"type": "update", "inputs": {"image": "a"}}}, "outputs": {"o": "v"}})",
     "g.json:2:47: error: `u` and `v` both update `a.image` in place: their order is open (at "
     "passes.v.inputs.image)\n"
     "  -> wire one after the other: `u.image`"},
    {"ReadBeforeAnUpdateThatComesFirst",
     R"({"passes": {"a": {"type": "source"}, "u": {"type": "update", "inputs": {"image": "a"}},
  "f": {"type": "blend", "inputs": {"a": "a", "b": "u"}}}, "outputs": {"o": "f"}})",
     "g.json:2:42: error: `f` must read `a` before `u` updates it in place, but it also waits for that pass "
     "(at passes.f.inputs.a)\n"
     "  -> read the updated value from `u`, or last frame's with @previous"},
    {"OutputUpdatedLater",
     R"({"passes": {"a": {"type": "source"}, "u": {"type": "update", "inputs": {"image": "a"}}}, "outputs": {"first": "a", "o": "u"}})",
     "g.json:1:111: error: `a` is updated in place later in the frame (at outputs.first)\n  -> wire the "
     "output to the last pass that updates it"},
    // ---- outputs and inputs of the graph
    {"OutputOfAnUnknownPass",
     R"({"passes": {"tonemap": {"type": "source"}}, "outputs": {"image": "tonmap.image"}})",
     "g.json:1:66: error: no pass `tonmap` (at outputs.image)\n  -> did you mean `tonemap`?"},
    {"OutputOfAnUnknownPort", R"({"passes": {"a": {"type": "source"}}, "outputs": {"image": "a.picture"}})",
     "g.json:1:60: error: no output `a.picture` (at outputs.image)\n  -> there is: a.image"},
    {"OutputIsANumber", R"({"passes": {"a": {"type": "source"}}, "outputs": {"image": 1, "o": "a"}})",
     "g.json:1:60: error: expected a wire such as \"pass.port\", found the number 1 (at outputs.image)"},
    {"OutputOfLastFrame",
     R"({"passes": {"a": {"type": "source"}}, "outputs": {"image": "a@previous", "o": "a"}})",
     "g.json:1:60: error: an output of the graph is what a pass writes in this frame (at outputs.image)\n  "
     "-> drop `@previous`"},
    {"OutputOfAnInput",
     R"({"inputs": {"i": {"format": "rgba16f"}}, "passes": {"a": {"type": "source"}}, "outputs": {"image": "inputs.i", "o": "a"}})",
     "g.json:1:100: error: an output of the graph is what a pass writes in this frame (at outputs.image)\n  "
     "-> wire it to a pass"},
    {"UnknownGraphInput",
     R"({"inputs": {"radiance": {"format": "rgba16f"}}, "passes": {"f": {"type": "filter", "inputs": {"image": "inputs.radianse"}}}, "outputs": {"o": "f"}})",
     "g.json:1:104: error: the graph has no input `inputs.radianse` (at passes.f.inputs.image)\n  -> did you "
     "mean `inputs.radiance`?"},
    {"UnknownFormat",
     R"({"inputs": {"i": {"format": "rgba16ff"}}, "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:29: error: no texel format: the text \"rgba16ff\" (at inputs.i.format)\n  -> did you mean "
     "`rgba16f`?"},
    {"LightInAFormatWithoutFloats",
     R"({"inputs": {"i": {"format": "rgba8", "light": true}}, "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:29: error: texels of the format `rgba8` cannot hold light (at inputs.i.format)\n  -> use a "
     "format of 16- or 32-bit floats, such as rgba16f"},
    {"InputWithoutAType",
     R"({"inputs": {"i": {"width": 4}}, "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:18: error: an input needs a `format` (image), an `element` (buffer) or a `bundle` (at "
     "inputs.i)"},
    {"InputOfNegativeSize",
     R"({"inputs": {"i": {"format": "r32f", "width": -4}}, "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:46: error: `width`: expected a whole number from 1 to 2147483648, found the number -4 (at "
     "inputs.i.width)"},
    {"InputWithAnUnknownKey",
     R"({"inputs": {"i": {"format": "r32f", "widht": 4}}, "passes": {"a": {"type": "source"}}, "outputs": {"o": "a"}})",
     "g.json:1:37: error: unknown key `widht` (at inputs.i.widht)\n  -> did you mean `width`?"},
};

INSTANTIATE_TEST_SUITE_P(All, LocatedErrors, testing::ValuesIn(kMistakes),
                         [](const testing::TestParamInfo<Mistake>& info) { return info.param.name; });

TEST(LocatedErrors, OfTheCommandLine) {
  const char* graph =
      R"({"parameters": {"n": 5}, "passes": {"a": {"type": "source", "params": {"count": "$n"}}}, "outputs": {"o": "a"}})";
  using testing::ElementsAre;
  EXPECT_THAT(
      errorsOf(graph, {{"n", "99"}}),
      ElementsAre("--set n=99: error: parameter `n`: expected a whole number from 1 to 10, found 99"));
  for (const char* text : {"5e0", "5.0", "0.5e1", "5", "1", "10.0"})
    EXPECT_THAT(errorsOf(graph, {{"a.count", text}}), ElementsAre()) << text;
  for (const char* text : {"5.5", "-1", "1e30", "4294967296", "many", "NaN", "0x5", "+5", "05"})
    EXPECT_THAT(errorsOf(graph, {{"a.count", text}}),
                ElementsAre(testing::HasSubstr("expected a whole number from 1 to 10, found ")))
        << text;
  EXPECT_THAT(errorsOf(graph, {{"a.count", "many"}}),
              ElementsAre("--set a.count=many: error: parameter `count`: expected a whole number from 1 to "
                          "10, found `many` (at passes.a.params.count)"));
  EXPECT_THAT(errorsOf(graph, {{"a.kernel", "disk"}}),
              ElementsAre("--set a.kernel=disk: error: parameter `kernel`: expected one of disc, clamp, "
                          "found `disk` (at passes.a.params.kernel)\n"
                          "  -> did you mean `disc`?"));
  EXPECT_THAT(errorsOf(graph, {{"a.cuont", "1"}}),
              ElementsAre("--set a.cuont=1: error: `source` has no parameter `cuont` (at "
                          "passes.a.params.cuont)\n  -> did you mean `count`?"));
}

// JSON has one kind of number: 5, 5.0 and 5e0 are the same.
TEST(LocatedErrors, WholeNumbersInEverySpelling) {
  const auto errors = [](const std::string& number) {
    return errorsOf(R"({"parameters": {"n": )" + number + R"(}, "passes": {"a": {"type": "source",
        "params": {"count": "$n"}}}, "outputs": {"o": "a"}})");
  };
  using testing::ElementsAre;
  for (const char* text : {"5e0", "5.0", "0.5e1", "5.000", "50e-1"})
    EXPECT_THAT(errors(text), ElementsAre()) << text;
  for (const char* text : {"5.5", "-1", "-1.0", "1e30", "4294967296", "\"5\"", "10.5"})
    EXPECT_THAT(errors(text), ElementsAre(testing::HasSubstr("expected a whole number from 1 to 10, found ")))
        << text;
}

TEST(LocatedErrors, AllOfAFileAtOnce) {
  const std::vector<std::string> errors = errorsOf(R"({
  "parameters": {"n": 1},
  "passes": {
    "a": {"type": "source", "params": {"count": 99, "radios": 1}},
    "b": {"type": "filtre", "inputs": {"image": "a"}},
    "c": {"type": "filter", "inputs": {"image": "nobody"}, "extra": 1},
    "d": {"type": "blend", "inputs": {"a": "a", "b": "e.vpls"}},
    "e": {"type": "emit", "params": {"vpl_count": "$m"}},
    "f": {"type": "filter"}},
  "outputs": {"o": "d", "p": "zz"},
  "wrong": 0})");
  std::string all;
  for (const std::string& e : errors) all += e + "\n";
  for (const char* place : {"g.json:4:49", "g.json:4:53", "g.json:5:19", "g.json:6:49", "g.json:6:60",
                            "g.json:7:54", "g.json:8:51", "g.json:9:5", "g.json:10:30", "g.json:11:3"})
    EXPECT_THAT(all, testing::HasSubstr(place + std::string(": error"))) << all;
  EXPECT_EQ(errors.size(), 10u) << all;
}

TEST(LocatedErrors, SizesNameTheExpression) {
  Registry registry;
  PassDeclaration d("grow", "Grows");
  d.parameter("n", integer(1, -1000000, 1000000000), "size");
  d.input("items", buffer("Item", 4), Usage::StorageRead, "read").makeOptional();
  d.output("image", image2D(kColor, parameter("n") * parameter("n"), ceilDiv(1, parameter("n"))),
           Usage::StorageWrite, "made");
  registry.add(d, nullptr);
  PassDeclaration e("follow", "Follows");
  e.input("image", image2D(kColor), Usage::Sampled, "read").makeOptional();
  e.output("out", image2D(kColor, widthOf("image"), 1), Usage::StorageWrite, "made");
  registry.add(e, nullptr);
  auto message = [&](const std::string& graph) {
    Diagnostics messages;
    try {
      bindText(graph, registry, messages);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  auto grow = [&](int n) {
    return message(fmt::format(
        R"({{"passes": {{"a": {{"type": "grow", "params": {{"n": {}}}}}}}, "outputs": {{"o": "a"}}}})", n));
  };
  EXPECT_EQ(grow(3), "");
  EXPECT_THAT(grow(0),
              testing::HasSubstr(
                  "graph.json:1:51: error: pass `a`: the width of `image`, n * n, is 0, it must be from 1 to "
                  "16777216 (at passes.a.params.n)\n  -> it depends on `n`"));
  EXPECT_THAT(grow(0), testing::Not(testing::HasSubstr("the height")));  // which follows from the same value
  EXPECT_THAT(grow(100000), testing::HasSubstr("is 10000000000, it must be from 1 to 16777216"));
  EXPECT_THAT(
      message(R"({"passes": {"a": {"type": "follow"}}, "outputs": {"o": "a"}})"),
      testing::HasSubstr(
          "the width of `out`, image.width, needs the size of the input `image`, which is not wired"));
  EXPECT_THAT(
      message(
          R"({"passes": {"a": {"type": "follow", "inputs": {"image": "a@previous"}}}, "outputs": {"o": "a"}})"),
      testing::HasSubstr("the width of `out`, image.width, depends on itself"));
}

}  // namespace
}  // namespace fovea::graph::test
