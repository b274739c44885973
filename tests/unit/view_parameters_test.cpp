// Tests what belongs to the frame: where its values come from, and who may ask for them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/graph/pass/expression.h"
#include "framework/graph/pass/validate.h"
#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

using testing::HasSubstr;

// A pass whose size follows from the materials of the frame.
std::shared_ptr<Registry> registryWithSurface() {
  auto registry = basicRegistry();
  PassDeclaration d("surface", "Makes an image");
  d.output("image", image2D(kColor, parameter("view.materials") * 6 + 1, 2), Usage::StorageWrite, "made");
  registry->add(d, nullptr);
  return registry;
}

struct Bound {
  BoundGraph graph;
  Diagnostics messages;
};

// `view`: of the graph; scene: what the environment says of materials, if anything.
Bound boundWith(const std::string& view, const std::vector<Override>& overrides = {},
                const std::string& scene = {}) {
  static const auto registry = registryWithSurface();
  Environment environment = basicEnvironment(*registry);
  if (!scene.empty()) environment.texts = {{"scene.materials", scene}};
  Bound bound;
  const std::string text =
      R"({"version": 2, )" + view + R"("passes": {"s": {"type": "surface"}}, "outputs": {"o": "s"}})";
  bound.graph = bind(loadText(text, "g.json", {overrides, {}}, bound.messages), environment, bound.messages);
  return bound;
}

std::string errorWith(const std::string& view, const std::vector<Override>& overrides = {}) {
  try {
    boundWith(view, overrides);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

uint32_t widthOf(const Bound& bound) { return bound.graph.resources[0].desc.width; }

TEST(ViewParameters, MaterialsComeFromTheRunTheGraphOrTheScene) {
  EXPECT_EQ(widthOf(boundWith("")), 1u);
  EXPECT_EQ(widthOf(boundWith("", {}, "full")), 7u);
  EXPECT_EQ(widthOf(boundWith(R"("view": {"materials": "diffuse"}, )", {}, "full")), 1u);
  EXPECT_EQ(widthOf(boundWith(R"("view": {"materials": "diffuse"}, )", {{"view.materials", "full"}})), 7u);
}

TEST(ViewParameters, PassesFindThemAmongTheirOwn) {
  const Bound bound = boundWith(R"("view": {"fovea_radius": 0.5}, )", {{"view.jitter", "4"}});
  const Parameters& parameters = bound.graph.passes[0].parameters;
  EXPECT_EQ(parameters.real("view.fovea_radius"), 0.5);
  EXPECT_EQ(parameters.integer("view.jitter"), 4);
  EXPECT_EQ(parameters.find("view.moon"), nullptr);
  EXPECT_EQ(bound.graph.view.text("materials"), "diffuse");
  EXPECT_TRUE(parameters.values().empty());
}

TEST(ViewParameters, AreAPartOfTheGraphsHash) {
  EXPECT_NE(boundWith("").graph.hash, boundWith(R"("view": {"fovea_radius": 0.5}, )").graph.hash);
}

TEST(ViewParameters, MistakesAreErrors) {
  EXPECT_THAT(errorWith(R"("view": {"materals": "full"}, )"),
              HasSubstr("g.json:1:25: error: the view has no parameter `materals` (at view.materals)"));
  EXPECT_THAT(errorWith(R"("view": {"fovea_radius": 9}, )"),
              HasSubstr("expected a number from 0.001 to 4, found 9"));
  EXPECT_THAT(
      errorWith("", {{"view.materials", "shiny"}}),
      HasSubstr("--set view.materials=shiny: error: parameter `materials`: expected one of diffuse, full"));
  EXPECT_THAT(errorWith("", {{"materials", "full"}}), HasSubstr("give --set view.materials=full"));
  EXPECT_THAT(errorWith("", {{"s.materials", "full"}}),
              HasSubstr("it belongs to the frame: set `materials` in \"view\" of the graph"));
}

TEST(ViewParameters, ExpressionsOfPassFilesKnowThem) {
  ExpressionError error;
  const SizeExpr expression = parseExpression("view.materials == full && view.jitter", error);
  EXPECT_EQ(error.message, "");
  EXPECT_EQ(expression.print(), "(view.materials == full) * view.jitter");
  PassDeclaration d("own", "Makes an image");
  d.output("image", image2D(kColor, parameter("view.moon"), 2), Usage::StorageWrite, "made");
  Diagnostics messages;
  validateDeclaration(d, messages);
  EXPECT_THAT(messages.format(), HasSubstr("`view.moon`, which is no whole-number parameter"));
}

}  // namespace
}  // namespace fovea::graph::test
