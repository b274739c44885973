// Tests the migrations of graph files: what they change, what they leave as it is written, and what loading says.
#include "framework/graph/migrate/migrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

using testing::HasSubstr;

std::string migrated(std::string_view text) {
  std::vector<Change> changes;
  return migrateText(text, "g.json", changes);
}

TEST(Migrate, AFileOfTheNewestVersionStaysAsItIs) {
  const std::string text =
      R"({ "version": 2, "passes": {"a": {"type": "gbuffer", "params": {"materials": "full"}}}})";
  std::vector<Change> changes;
  EXPECT_EQ(migrateText(text, "g.json", changes), text);
  EXPECT_TRUE(changes.empty());
}

TEST(Migrate, WhatBelongsToTheFrameMovesToTheView) {
  EXPECT_EQ(migrated(R"({
  "$schema": "fovea-graph.schema.json",
  "parameters": { "fovea_radius": 0.15, "count": 7, "materials": "$scene.materials" },
  "passes": {
    "g": { "type": "gbuffer", "params": { "materials": "$materials" } },   
    "c": { "type": "candidates", "params": { "count": "$count",  "fovea_radius": "$fovea_radius" } }
  }
}
)"),
            R"({
  "$schema": "fovea-graph.schema.json",
  "version": 2,
  "view": { "fovea_radius": 0.15 },
  "parameters": { "count": 7 },
  "passes": {
    "g": { "type": "gbuffer" },   
    "c": { "type": "candidates", "params": { "count": "$count" } }
  }
}
)");
}

TEST(Migrate, ReservoirsOfThePreviousFrameAreMoved) {
  EXPECT_EQ(migrated(R"({
  "passes": {
    "temporal-visibility": {
      "type": "reservoirs-visibility-$tracer",
      "inputs": { "gbuffer": "gbuffer", "other_gbuffer": "gbuffer@previous", "others": "temporal@previous" },
      "params": { "previous": true }
    },
    "temporal": {
      "type": "reservoirs-merge",
      "inputs": { "gbuffer": "gbuffer", "other_gbuffer": "gbuffer@previous", "others": "temporal@previous" }
    },
    "spatial": { "type": "reservoirs-merge", "inputs": { "gbuffer": "gbuffer", "other_gbuffer": "gbuffer", "others": "temporal" } }
  }
}
)"),
            R"({
  "version": 2,
  "view": { "materials": "diffuse" },
  "passes": {
    "temporal-motion": { "type": "reservoirs-motion", "inputs": { "previous": "gbuffer@previous", "samples": "temporal@previous" } },
    "temporal-visibility": {
      "type": "reservoirs-visibility",
      "inputs": { "gbuffer": "gbuffer", "moved": "temporal-motion.moved", "others": "temporal-motion.reservoirs" }
    },
    "temporal": {
      "type": "reservoirs-merge",
      "inputs": { "gbuffer": "gbuffer", "moved": "temporal-motion.moved", "others": "temporal-motion.reservoirs" }
    },
    "spatial": { "type": "reservoirs-merge", "inputs": { "gbuffer": "gbuffer", "others": "temporal" } }
  }
}
)");
}

// A variant names only what it changes.
TEST(Migrate, ParametersOfVariantsMoveToTheView) {
  EXPECT_EQ(migrated(R"({"extends": "foveal.json", "parameters": {"jitter": 4, "materials": "full"}})"),
            R"({"version": 2, "extends": "foveal.json", "view": { "jitter": 4, "materials": "full" }})");
}

TEST(Migrate, ValuesInPassesMoveToTheView) {
  EXPECT_EQ(
      migrated(R"({"extends": "ours.json", "passes": {"deferred": {"params": {"materials": "full"}}}})"),
      R"({"version": 2, "extends": "ours.json", "view": { "materials": "full" }, "passes": {"deferred": {}}})");
}

TEST(Migrate, PassesThatTraceRaysLoseTheirPlace) {
  const std::string text =
      migrated(R"({"extends": "base.json", "parameters": {"rays": "$device.rays"}, "passes": {
    "a": {"type": "near-field-$rays"}, "b": {"type": "shadow-rays-host"}, "c": {"type": "near-field-pixels-device"},
    "d": {"type": "reflection-vectors"}, "e": {"graph": "eye.json", "parameters": {"rays": "$rays", "kernel": "disc"}}}})");
  EXPECT_EQ(text, R"({"version": 2, "extends": "base.json", "passes": {
    "a": {"type": "near-field"}, "b": {"type": "shadow-rays"}, "c": {"type": "near-field-pixels"},
    "d": {"type": "reflection-vectors"}, "e": {"graph": "eye.json", "parameters": {"kernel": "disc"}}}})");
}

// Of probes, `rays` is a number, and a parameter of a pass that is not of this project may have any name.
TEST(Migrate, OtherMeaningsOfANameStay) {
  const std::string text = R"({ "version": 2, "extends": "b.json", "parameters": { "rays": 64, "jitter": 1 },
    "passes": { "p": { "type": "probe-blend", "params": { "n": "$rays" } },
                "own": { "type": "shake", "params": { "jitter": "$jitter", "materials": 3 } } } })";
  std::string old = text;
  old.erase(1, std::string(R"( "version": 2,)").size());
  EXPECT_EQ(migrated(old), text);
}

TEST(Migrate, DefaultsThatHaveChangedAreSpeltOut) {
  EXPECT_EQ(
      migrated(R"({"passes": {"g": {"type": "gbuffer"}, "a": {"type": "antialias"}}})"),
      R"({"version": 2, "view": { "jitter": 8, "materials": "diffuse" }, "passes": {"g": {"type": "gbuffer"}, "a": {"type": "antialias"}}})");
  EXPECT_THAT(migrated(R"({"passes": {"n": {"type": "near-field-host", "params": {"fovea_radius": 4}}}})"),
              HasSubstr(R"("params": {"spacing": 2})"));
}

TEST(Migrate, GraphParametersOfFovealBecomeThoseOfPasses) {
  EXPECT_EQ(
      migrated(R"({"extends": "foveal.json", "parameters": {"history_frames": 8, "vpl_count": 5}})"),
      R"({"version": 2, "extends": "foveal.json", "parameters": {"vpl_count": 5}, "passes": { "indirect-mean": { "params": { "frames": 8 } } }})");
  EXPECT_EQ(migrated(R"({"extends": "foveal", "parameters": {"paths": null}})"),
            R"({"version": 2, "extends": "foveal"})");
}

// Loading does in memory what the program does to the file, keeps the places of what the user wrote, and says so once.
TEST(Migrate, LoadingAnOldFileWarns) {
  Diagnostics messages;
  const Description graph = loadText(R"({"passes": {
    "d": {"type": "draw"}, "c": {"type": "candidates", "params": {"fovea_radius": 9}}}, "outputs": {"o": "d"}})",
                                     "old.json", {}, messages);
  ASSERT_EQ(messages.list().size(), 1u);
  EXPECT_EQ(messages.list()[0].severity, Severity::Warning);
  EXPECT_THAT(messages.format(), HasSubstr("old.json:2:83: warning: a graph of version 1"));
  EXPECT_THAT(messages.format(), HasSubstr("`fovea migrate old.json` rewrites it"));
  ASSERT_EQ(graph.view.size(), 1u);
  EXPECT_EQ(graph.view[0].value->where.line, 2);
}

TEST(Migrate, AVersionThatIsNotKnownIsAnError) {
  for (const char* version : {"3", "0", "\"2\""}) {
    Diagnostics messages;
    loadText(
        fmt::format(R"({{"version": {}, "passes": {{"a": {{"type": "source"}}}}, "outputs": {{"o": "a"}}}})",
                    version),
        "new.json", {}, messages);
    EXPECT_THAT(messages.format(), HasSubstr("new.json:1:13: error: expected a version from 1 to 2"))
        << version;
  }
}

}  // namespace
}  // namespace fovea::graph::test
