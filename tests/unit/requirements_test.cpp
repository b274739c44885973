// What passes require of their parameters and inputs: where it is reported, and which values are offered because of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "framework/graph/compile/fitting.h"
#include "framework/graph/pass/validate.h"
#include "framework/graph/report/settings.h"
#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

PassDeclaration mix() {
  PassDeclaration d("mix", "Mixes two images");
  d.input("a", image2D(kColor), Usage::Sampled, "first");
  d.input("b", image2D(kColor), Usage::Sampled, "second").makeOptional();
  d.output("image", image2D(kColor), Usage::StorageWrite, "written");
  d.parameter("show", choice("a", {"a", "b", "both"}), "what")
      .parameter("swap", flag(false), "whether")
      .parameter("share", real(0, 0, 1), "how much")
      .parameter("block", integer(2, {1, 2, 4}), "width of a block");
  d.require(is("show", "a") || wired("b"), "it cannot show `b`, which is not wired", "wire `b`, or show `a`");
  d.require(!parameter("swap") || wired("b"), "nothing to swap", "wire `b`, or set swap to false");
  d.require(atMost(parameter("share"), 0) || wired("b"), "a share of nothing", "wire `b`");
  d.require(same(widthOf("a"), widthOf("b")), "`a` and `b` have different widths", "wire images of one size");
  d.require(!is("view.materials", "full"), "it mixes diffuse light only", "use diffuse materials");
  return d;
}

std::shared_ptr<Registry> registry() {
  auto made = basicRegistry();
  made->add(mix(), nullptr);
  PassDeclaration wide("wide", "Makes an image of some width");
  wide.parameter("width", integer(128, 1, 1024), "texels");
  wide.output("image", image2D(kColor, parameter("width"), 64), Usage::StorageWrite, "made");
  made->add(wide, nullptr);
  PassDeclaration wider("wider", "Makes an image as wide as the wider one of two");
  wider.input("a", image2D(kColor), Usage::Sampled, "first");
  wider.input("b", image2D(kColor), Usage::Sampled, "second");
  wider.output("image", image2D(kColor, max(widthOf("a"), widthOf("b")), 64), Usage::StorageWrite, "made");
  made->add(wider, nullptr);
  return made;
}

// A graph with a pass `m` of the type `mix`, which has these inputs and parameters.
std::string graph(const std::string& inputs, const std::string& params = "{}", const std::string& more = "") {
  return R"({"version": 2, "parameters": {"show": "a"}, )" + more +
         R"("passes": {"s": {"type": "source"}, "h": {"type": "half", "inputs": {"image": "s"}},
"m": {"type": "mix", "inputs": )" +
         inputs + ",\n\"params\": " + params + R"(},
"w": {"type": "wide"}, "n": {"type": "half", "inputs": {"image": "w"}}}, "outputs": {"o": "m"}})";
}

std::string errorOf(const std::string& text, const std::vector<Override>& overrides = {}) {
  const auto known = registry();
  Diagnostics messages;
  try {
    bind(loadText(text, "g.json", {overrides, {}}, messages), basicEnvironment(*known), messages);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_EQ(std::ranges::count(messages.list(), Severity::Error, &Diagnostic::severity), 1);
    return e.what();
  }
  return "no error";
}

const std::string kOne = R"({"a": "s"})", kTwo = R"({"a": "s", "b": "s"})",
                  kSizes = R"({"a": "s", "b": "h"})";

TEST(Requirements, OfAValueAreReportedAtTheValue) {
  EXPECT_EQ(errorOf(graph(kOne)), "no error");
  EXPECT_EQ(errorOf(graph(kTwo, R"({"show": "both", "swap": true, "share": 0.5})")), "no error");
  EXPECT_THAT(errorOf(graph(kOne, R"({"show": "b"})")),
              HasSubstr("g.json:3:20: error: pass `m`: it cannot show `b`, which is not wired (at "
                        "passes.m.params.show)\n  -> wire `b`, or show `a`"));
  EXPECT_THAT(errorOf(graph(kOne, R"({"show": "$show"})"), {{"show", "both"}}),
              HasSubstr("--set show=both: error: pass `m`: it cannot show `b`"));
  EXPECT_THAT(errorOf(graph(kOne), {{"m.swap", "true"}}),
              HasSubstr("--set m.swap=true: error: pass `m`: nothing to swap"));
  EXPECT_THAT(errorOf(graph(kOne, R"({"share": 0.001})")), HasSubstr("a share of nothing"));
  EXPECT_THAT(errorOf(graph(kOne), {{"view.materials", "full"}}),
              HasSubstr("--set view.materials=full: error: pass `m`: it mixes diffuse light only"));
}

TEST(Requirements, OfWiresAreReportedAtTheWire) {
  EXPECT_THAT(
      errorOf(graph(kSizes)),
      HasSubstr(
          "g.json:2:38: error: pass `m`: `a` and `b` have different widths (a.width is 64, b.width is 32)"));
}

TEST(Requirements, OfSizesAreReportedAtTheValueFromWhichTheyFollow) {
  EXPECT_THAT(errorOf(graph(R"({"a": "s", "b": "n"})"), {{"w.width", "8"}}),
              HasSubstr("--set w.width=8: error: pass `m`: `a` and `b` have different widths (a.width is 64, "
                        "b.width is 4)"));
}

// Sizes that follow from two inputs, each of which does so, are looked at once each, not once a way that leads there.
TEST(Requirements, OfSizesThatFollowInManyWaysAreReportedSoon) {
  std::string text = graph(R"({"a": "s", "b": "z63"})");
  std::string chain, before = "w";
  for (int i = 0; i < 64; ++i) {
    const std::string name = "z" + std::to_string(i);
    chain += "\"" + name + R"(": {"type": "wider", "inputs": {"a": ")" + before + R"(", "b": ")" + before +
             "\"}},\n";
    before = name;
  }
  text.insert(text.find(R"("w": {)"), chain);
  EXPECT_THAT(errorOf(text, {{"w.width", "8"}}), HasSubstr("--set w.width=8: error: pass `m`: `a` and `b`"));
}

TEST(Requirements, OfPassesThatDoNotRunDoNotMatter) {
  std::string text = graph(kOne, R"({"show": "b"})");
  text.replace(text.find(R"({"o": "m"})"), 10, R"({"o": "s"})");
  EXPECT_EQ(errorOf(text), "no error");
}

TEST(Requirements, OtherMistakesComeFirst) {
  EXPECT_THAT(errorOf(graph(kOne, R"({"show": "b", "block": 3})")),
              HasSubstr("parameter `block`: expected one of 1, 2, 4, found 3"));
}

TEST(Requirements, OnlyValuesThatMeetThemAreOffered) {
  const auto known = registry();
  const auto offered = [&](const std::string& inputs, const std::string& parameter) {
    Diagnostics messages;
    const Description description = loadText(graph(inputs, R"({"show": "$show"})"), "g.json", {}, messages);
    const Environment environment = basicEnvironment(*known);
    if (parameter == "$show") return settings(description, environment)[0].spec.choices;
    return fittingSpec(description, environment, 2, *findParameter(known->find("mix")->parameters, parameter))
        .choices;
  };
  EXPECT_THAT(offered(kOne, "$show"), ElementsAre("a"));
  EXPECT_THAT(offered(kTwo, "$show"), ElementsAre("a", "b", "both"));
  EXPECT_THAT(offered(kOne, "show"), ElementsAre("a"));
  EXPECT_THAT(offered(kOne, "swap"), ElementsAre("false"));
  EXPECT_THAT(offered(kTwo, "swap"), IsEmpty());  // both
  EXPECT_THAT(offered(kOne, "block"), ElementsAre("1", "2", "4"));
}

TEST(Requirements, AreCheckedWhenAPassIsRegistered) {
  const auto messageOf = [](SizeExpr condition, const std::string& message = "wrong") -> std::string {
    PassDeclaration d = mix();
    d.require(std::move(condition), message, "");
    try {
      validateDeclaration(d);
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_EQ(messageOf(atMost(widthOf("a"), viewWidth())), "no error");
  EXPECT_THAT(messageOf(wired("c")), HasSubstr("`c` is no parameter, choice or size of an input"));
  EXPECT_THAT(messageOf(wired("image")), HasSubstr("`image` is no"));
  EXPECT_THAT(messageOf(countOf("a")), HasSubstr("`a` is no"));
  EXPECT_THAT(messageOf(isRead("image")), HasSubstr("`image` is no"));
  EXPECT_THAT(messageOf(is("show", "c")), HasSubstr("`show` is no"));
  EXPECT_THAT(messageOf(parameter("radius")), HasSubstr("`radius` is no"));
  EXPECT_THAT(messageOf(1, ""), HasSubstr("does not say what is wrong"));
}

TEST(Requirements, CompareNumbers) {
  const auto value = [](const SizeExpr& condition) {
    PassDeclaration d("one", "One");
    d.output("image", image2D(kColor, condition + 1, 1), Usage::StorageWrite, "made");
    Registry known;
    known.add(d, nullptr);
    Diagnostics messages;
    const auto bound = bindText(R"({"version": 2, "passes": {"o": {"type": "one"}}, "outputs": {"o": "o"}})",
                                known, messages);
    return bound->resources[0].desc.width - 1;
  };
  for (const int64_t a : {0, 3, 4, 70000})
    for (const int64_t b : {0, 3, 4, 70000}) {
      EXPECT_EQ(value(same(a, b)), uint32_t(a == b)) << a << " " << b;
      EXPECT_EQ(value(atMost(a, b)), uint32_t(a <= b)) << a << " " << b;
    }
}

}  // namespace
}  // namespace fovea::graph::test
