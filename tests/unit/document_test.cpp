// Graphs as documents: the facade fovea/document.h.
#include "fovea/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/passes.h"

namespace fovea::graph {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string planOf(const Document& document) {
  passes::registerAll();
  Diagnostics messages;
  return check(document, PlanForm::Text, {.size = {64, 64}}, messages);
}

TEST(Document, MergesWhatItExtends) {
  const Document document =
      Document::parse(R"({"version": 2, "extends": "direct", "description": "mine"})", "a.json");
  EXPECT_THAT(document.text(), HasSubstr("extends"));
  const std::string merged = document.merged().text();
  EXPECT_THAT(merged, Not(HasSubstr("extends")));
  EXPECT_THAT(merged, HasSubstr("mine"));
  EXPECT_THAT(merged, HasSubstr("tonemap"));
}

TEST(Document, APatchReplacesAndRemoves) {
  const Document document = Document::load("direct").patched(
      R"({"passes": {"tonemap": {"params": {"exposure": 2.5}}}, "outputs": {"direct": null}})");
  EXPECT_THAT(document.text(), HasSubstr("2.5"));
  EXPECT_THAT(planOf(document), HasSubstr("tonemap"));
  EXPECT_THAT(planOf(document), Not(HasSubstr("output direct")));
}

TEST(Document, MistakesInAPatchHaveTheirPlaceInIt) {
  const Document document =
      Document::load("direct").patched("{\n  \"passes\": {\"tonemap\": {\"type\": \"tonemop\"}}}", "cell");
  try {
    planOf(document);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostics()[0].where.file, "cell");
    EXPECT_EQ(error.diagnostics()[0].where.line, 2);
    EXPECT_THAT(error.diagnostics()[0].remedy, HasSubstr("tonemap"));
  }
  EXPECT_THROW(Document::load("direct").patched(R"({"outputs": {"nothing": null}})"), Error);
  EXPECT_THROW(Document::load("direct").patched("[]"), Error);
}

}  // namespace
}  // namespace fovea::graph
