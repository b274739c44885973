// Tests the schedule: levels, culling, versions and lifetimes.
#include "framework/graph/compile/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

std::string orderOf(const std::string& passes, const std::string& output = "end") {
  return compileText("{\"passes\": {" + passes + "}, \"outputs\": {\"o\": \"" + output + "\"}}").order();
}

std::string pass(const std::string& name, const std::string& type, const std::string& inputs = "") {
  return "\"" + name + "\": {\"type\": \"" + type + "\", \"inputs\": {" + inputs + "}}";
}

TEST(Schedule, ChainWhateverTheDeclarationOrder) {
  const std::string a = pass("a", "source"), b = pass("b", "filter", "\"image\": \"a\""),
                    c = pass("end", "filter", "\"image\": \"b\"");
  EXPECT_EQ(orderOf(a + "," + b + "," + c), "a | b | end");
  EXPECT_EQ(orderOf(c + "," + b + "," + a), "a | b | end");
}

TEST(Schedule, DiamondKeepsDeclarationOrderWithinALevel) {
  EXPECT_EQ(orderOf(pass("a", "source") + "," + pass("y", "filter", "\"image\": \"a\"") + "," +
                    pass("x", "filter", "\"image\": \"a\"") + "," +
                    pass("end", "blend", "\"a\": \"x\", \"b\": \"y\"")),
            "a | y x | end");
}

TEST(Schedule, EarliestLevel) {
  // `late` is only needed at the end but can run at once.
  EXPECT_EQ(orderOf(pass("a", "source") + "," + pass("b", "filter", "\"image\": \"a\"") + "," +
                    pass("late", "source") + "," + pass("end", "blend", "\"a\": \"b\", \"b\": \"late\"")),
            "a late | b | end");
}

TEST(Schedule, CullsWhatNothingNeeds) {
  const Compiled c = compileText(
      "{\"passes\": {" + pass("a", "source") + "," + pass("unused", "filter", "\"image\": \"a\"") + "," +
      pass("unused2", "filter", "\"image\": \"unused\"") + "," + pass("end", "filter", "\"image\": \"a\"") +
      "}, \"outputs\": {\"o\": \"end\"}}");
  EXPECT_EQ(c.order(), "a | end");
  EXPECT_FALSE(c.plan.passLive[c.pass("unused")]);
  EXPECT_FALSE(c.plan.resourceLive[c.resource("unused.image_out")]);
  EXPECT_TRUE(c.plan.resourceLive[c.resource("a.image")]);
}

TEST(Schedule, SideEffectsAreNeverCulled) {
  EXPECT_EQ(
      orderOf(pass("end", "source") + "," + pass("a", "source") + "," + pass("l", "log", "\"image\": \"a\"")),
      "end a | l");
}

TEST(Schedule, AHistoryEdgeIsFollowedWhenCulling) {
  // b reads what c wrote in the last frame, so c runs although no output needs it in this frame.
  EXPECT_EQ(
      orderOf(pass("a", "source") + "," + pass("end", "blend", "\"a\": \"a\", \"b\": \"c@previous\"") + "," +
              pass("c", "filter", "\"image\": \"a\"") + "," + pass("d", "filter", "\"image\": \"a\"")),
      "a | end c");
}

TEST(Schedule, AHistoryEdgeIsNoCycle) {
  EXPECT_EQ(
      orderOf(pass("a", "source") + "," + pass("end", "blend", "\"a\": \"a\", \"b\": \"end@previous\"")),
      "a | end");
}

TEST(Schedule, UpdatesInPlaceWaitForReadersOfTheOldValue) {
  // r reads a before u changes it; r2 reads the changed value.
  EXPECT_EQ(orderOf(pass("a", "source") + "," + pass("u", "update", "\"image\": \"a\"") + "," +
                    pass("r", "filter", "\"image\": \"a\"") + "," + pass("r2", "filter", "\"image\": \"u\"") +
                    "," + pass("end", "blend", "\"a\": \"r\", \"b\": \"r2\"")),
            "a | r | u | r2 | end");
}

TEST(Schedule, VersionsCountUpdates) {
  const Compiled c =
      compileText("{\"passes\": {" + pass("a", "source") + "," + pass("u", "update", "\"image\": \"a\"") +
                  "," + pass("v", "update", "\"image\": \"u\"") + "," +
                  pass("end", "filter", "\"image\": \"v\"") + "}, \"outputs\": {\"o\": \"end\"}}");
  EXPECT_EQ(c.order(), "a | u | v | end");
  const BoundGraph& g = *c.graph;
  EXPECT_EQ(g.passes[0].accesses[0].version, 1u);
  EXPECT_EQ(g.passes[1].accesses[0].version, 2u);
  EXPECT_EQ(g.passes[2].accesses[0].version, 3u);
  EXPECT_EQ(g.passes[3].accesses[0].version, 3u);
  EXPECT_EQ(g.passes[3].accesses[0].resource, g.passes[0].accesses[0].resource);
}

TEST(Schedule, AnUpdateNobodyReadsIsCulled) {
  EXPECT_EQ(orderOf(pass("a", "source") + "," + pass("u", "update", "\"image\": \"a\"") + "," +
                    pass("end", "filter", "\"image\": \"a\"")),
            "a | end");
}

TEST(Schedule, AnUpdateOfSomethingKeptIsNotCulled) {
  // The next frame sees what u leaves in the kept image.
  EXPECT_EQ(
      orderOf(pass("a", "source") + "," + pass("k", "keep", "\"image\": \"a\"") + "," +
              pass("u", "update", "\"image\": \"k\"") + "," + pass("end", "filter", "\"image\": \"k\"")),
      "a | k | end | u");
}

TEST(Schedule, FanInOfManyIsOneLevel) {
  std::string passes;
  for (int i = 0; i < 50; ++i) passes += pass("s" + std::to_string(i), "source") + ",";
  for (int i = 0; i < 25; ++i)
    passes +=
        pass("b" + std::to_string(i), "blend",
             "\"a\": \"s" + std::to_string(2 * i) + "\", \"b\": \"s" + std::to_string(2 * i + 1) + "\"") +
        ",";
  passes += pass("end", "blend", "\"a\": \"b0\", \"b\": \"b24\"");
  const Compiled c = compileText("{\"passes\": {" + passes + "}, \"outputs\": {\"o\": \"end\"}}");
  EXPECT_EQ(c.order(), "s0 s1 s48 s49 | b0 b24 | end");
}

TEST(Schedule, LifetimesReachFromFirstToLastUse) {
  const Compiled c =
      compileText("{\"passes\": {" + pass("a", "source") + "," + pass("b", "filter", "\"image\": \"a\"") +
                  "," + pass("c", "filter", "\"image\": \"b\"") + "," +
                  pass("end", "blend", "\"a\": \"c\", \"b\": \"a\"") + "}, \"outputs\": {\"o\": \"end\"}}");
  const Schedule s = schedule(*c.graph);
  const std::vector<Interval> life = lifetimes(*c.graph, s);
  auto expect = [&](const char* name, uint32_t first, uint32_t last) {
    EXPECT_EQ(life[c.resource(name)].first, first) << name;
    EXPECT_EQ(life[c.resource(name)].last, last) << name;
  };
  expect("a.image", 0, 3);
  expect("b.image_out", 1, 2);
  expect("c.image_out", 2, 3);
  expect("end.image", 3, 4);  // an output: to the end of the frame
}

TEST(Schedule, RandomOrdersAreLegalAndDiffer) {
  std::string passes;
  for (int i = 0; i < 8; ++i) passes += pass("s" + std::to_string(i), "source") + ",";
  for (int i = 0; i < 4; ++i)
    passes +=
        pass("b" + std::to_string(i), "blend",
             "\"a\": \"s" + std::to_string(2 * i) + "\", \"b\": \"s" + std::to_string(2 * i + 1) + "\"") +
        ",";
  passes += pass("c0", "blend", "\"a\": \"b0\", \"b\": \"b1\"") + "," +
            pass("c1", "blend", "\"a\": \"b2\", \"b\": \"b3\"") + "," +
            pass("end", "blend", "\"a\": \"c0\", \"b\": \"c1\"");
  const Compiled c = compileText("{\"passes\": {" + passes + "}, \"outputs\": {\"o\": \"end\"}}");
  std::set<std::vector<uint32_t>> seen;
  for (uint32_t seed = 0; seed < 50; ++seed) {
    const Schedule s = schedule(*c.graph, seed);
    EXPECT_EQ(s.order, schedule(*c.graph, seed).order);  // the same for the same seed
    seen.insert(s.order);
    ASSERT_EQ(s.order.size(), c.graph->passes.size());
    for (uint32_t p = 0; p < c.graph->passes.size(); ++p)
      for (const Access& read : c.graph->passes[p].accesses)
        for (uint32_t w = 0; w < c.graph->passes.size() && !read.writes; ++w)
          for (const Access& write : c.graph->passes[w].accesses)
            if (write.writes && write.resource == read.resource) {
              EXPECT_LT(s.level[w], s.level[p]);
            }
  }
  EXPECT_GT(seen.size(), 40u);
}

}  // namespace
}  // namespace fovea::graph::test
