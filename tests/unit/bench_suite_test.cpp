// Tests what suites of benchmarks expand to, and that the message for every mistake gives its position.
#include "benchmarks/runner/suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "framework/session/inputs.h"
#include "graph_support.h"
#include "places.h"

namespace fovea::bench {
namespace {

using graph::test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> namesOf(const Suite& suite) {
  std::vector<std::string> names;
  for (const Job& job : suite.jobs) names.push_back(job.name());
  return names;
}

std::string errorOf(const std::string& text) {
  try {
    parseSuite(text, "s.json");
    return "";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    return e.what();
  }
}

TEST(BenchSuite, JobsAreAllCombinationsOneSceneAfterTheOtherSeedBySeed) {
  const Suite suite = parseSuite(R"({
    "scenes": ["a", "b"], "graphs": ["ours"], "set": {"kernel": "disc"},
    "sweeps": [{"name": "n", "set": {"vpl_count": [1, 2]}, "seeds": 2}, {"name": "m", "graphs": [{"graph": "x/ir.json"}]}]
  })",
                                 "s.json");
  EXPECT_THAT(namesOf(suite), ElementsAre("n-a-ours-vpl_count=1-s1", "n-a-ours-vpl_count=2-s1",
                                          "n-a-ours-vpl_count=1-s2", "n-a-ours-vpl_count=2-s2", "m-a-ir-s1",
                                          "n-b-ours-vpl_count=1-s1", "n-b-ours-vpl_count=2-s1",
                                          "n-b-ours-vpl_count=1-s2", "n-b-ours-vpl_count=2-s2", "m-b-ir-s1"));
  using Pair = std::pair<std::string, std::string>;
  EXPECT_THAT(suite.jobs[1].set, ElementsAre(Pair("kernel", "disc"), Pair("vpl_count", "2")));
  EXPECT_THAT(suite.jobs[1].varied, ElementsAre(Pair("vpl_count", "2")));
  EXPECT_EQ(suite.jobs[4].graph, "x/ir.json");
}

TEST(BenchSuite, ASweepsWordReplacesTheHeads) {
  const Suite suite = parseSuite(R"({
    "scenes": ["a"], "graphs": ["ours"], "size": "64x32", "frames": 3, "reference": {"spp": 7}, "measures": ["time"],
    "sweeps": [{"name": "n"}, {"name": "m", "size": ["8x8", "9x9"], "frame_rate": 84, "reference": {"depth": 2}, "measures": ["temporal", "eyes"]}]
  })",
                                 "s.json");
  ASSERT_EQ(suite.jobs.size(), 3u);
  EXPECT_EQ(suite.jobs[0].size, glm::uvec2(64, 32));
  EXPECT_FALSE(suite.jobs[0].needsReference());
  EXPECT_EQ(suite.jobs[2].size, glm::uvec2(9, 9));
  EXPECT_EQ(suite.jobs[2].name(), "m-a-ours-size=9x9-s1");
  EXPECT_EQ(suite.jobs[2].frameRate, 84);
  EXPECT_EQ(suite.jobs[2].spp, 7u);
  EXPECT_EQ(suite.jobs[2].depth, 2u);
  EXPECT_TRUE(suite.jobs[2].temporal);
  EXPECT_TRUE(suite.jobs[2].eyes);
  EXPECT_FALSE(suite.jobs[2].error);
  EXPECT_EQ(suite.jobs[2].json()["measures"], (std::vector<std::string>{"time", "temporal", "eyes"}));
}

TEST(BenchSuite, SizeAndSeedsOfTheCommandLine) {
  const char* text =
      R"({"scenes": ["a"], "graphs": ["g"], "sweeps": [{"name": "n"}, {"name": "m", "size": ["8x8", "9x9"]}]})";
  const Suite suite = parseSuite(text, "s.json", {.size = glm::uvec2(5, 6), .seeds = 2});
  ASSERT_EQ(suite.jobs.size(), 6u);
  EXPECT_EQ(suite.jobs[1].size, glm::uvec2(5, 6));
  EXPECT_EQ(suite.jobs[1].seed, 2u);
  EXPECT_EQ(suite.jobs[2].size, glm::uvec2(8, 8));  // sizes that the sweep varies stay
}

TEST(BenchSuite, ScenesOfTheCommandLineReplaceThoseOfAllSweeps) {
  const char* text =
      R"({"scenes": ["a"], "graphs": ["g"], "sweeps": [{"name": "n"}, {"name": "m", "scenes": ["b"]}]})";
  const Suite suite = parseSuite(text, "s.json", {.scenes = {"x/mine.json", "c"}});
  EXPECT_THAT(namesOf(suite), ElementsAre("n-mine-g-s1", "m-mine-g-s1", "n-c-g-s1", "m-c-g-s1"));
  EXPECT_EQ(suite.jobs[0].scene, "x/mine.json");
}

TEST(BenchSuite, AFolderStandsForTheSceneFilesInIt) {
  TempFolder folder;
  for (const char* name : {"b.json", "a.json", "a.bin"}) folder.write(name, "{}");
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  EXPECT_THAT(session::sceneNames({"room", path("")}), ElementsAre("room", path("a.json"), path("b.json")));
  EXPECT_THROW(session::sceneNames({path("a.json"), "elsewhere/a.gltf"}),
               Error);  // results would have one name
  std::filesystem::create_directory(folder.path() / "empty");
  EXPECT_THROW(session::sceneNames({path("empty/")}), Error);
}

TEST(BenchSuite, AScaleChangesSizesAndAmountsOfWork) {
  const char* text =
      R"({"scenes": ["a", "b", "c"], "size": "64x64", "warmup": 9, "seeds": 3, "measures": ["temporal"],
    "frames": 8, "graphs": ["g", {"graph": "h", "warmup": 1}],
    "scales": {"tiny": {"size": "16x8", "seeds": 1, "spp": 4, "max_frames": 3, "max_warmup": 2, "max_values": 3,
                        "scenes": ["c", "a"]}, "own": {}},
    "sweeps": [{"name": "n", "set": {"v": [1, 2, 3, 4, 5], "w": [1, 2]}}, {"name": "m", "scenes": ["b"], "frames": 2},
               {"name": "o", "size": ["8x8", "9x9"]}]})";
  const Suite suite = parseSuite(text, "s.json", {.scale = "tiny"});
  EXPECT_THAT(suite.scales, ElementsAre("tiny", "own"));
  std::vector<std::string> first;
  for (const Job& job : suite.jobs)
    if (job.sweep == "n" && job.scene == "a" && job.graph == "g") first.push_back(job.name());
  EXPECT_THAT(first, ElementsAre("n-a-g-v=1-w=1-s1", "n-a-g-v=1-w=2-s1", "n-a-g-v=3-w=1-s1",
                                 "n-a-g-v=3-w=2-s1", "n-a-g-v=5-w=1-s1", "n-a-g-v=5-w=2-s1"));
  for (const Job& job : suite.jobs) {
    EXPECT_EQ(job.spp, 4u);
    EXPECT_EQ(job.seed, 1u);
    EXPECT_EQ(job.frames, job.sweep == "m" ? 2u : 3u);  // a limit, not another value
    EXPECT_EQ(job.warmup, job.graph == "h" ? 1u : 2u);
    EXPECT_EQ(job.size == glm::uvec2(16, 8), job.sweep != "o");
    // Scenes of the sweep that the scale has, too, in the order of the sweep; its first scene if there are none.
    EXPECT_EQ(job.scene == "b", job.sweep == "m");
  }
  EXPECT_EQ(namesOf(parseSuite(text, "s.json", {.scale = "own"})), namesOf(parseSuite(text, "s.json")));
  const Suite mine =
      parseSuite(text, "s.json", {.size = glm::uvec2(5, 5), .seeds = 2, .scenes = {"z"}, .scale = "tiny"});
  EXPECT_EQ(mine.jobs.front().size, glm::uvec2(5, 5));
  EXPECT_EQ(mine.jobs.front().scene, "z");
  EXPECT_EQ(mine.jobs.back().seed, 2u);
}

TEST(BenchSuite, AnUnknownScaleIsAMistakeOfTheCommandLine) {
  const auto errorWith = [](const std::string& scales) {
    try {
      parseSuite(R"({"scenes": ["a"], "graphs": ["g"], "sweeps": [{"name": "n"}])" + scales + "}", "s.json",
                 {.scale = "tini"});
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::Usage);
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(errorWith(R"(, "scales": {"tiny": {}, "huge": {}})"),
              testing::AllOf(HasSubstr("`tini`"), HasSubstr("its scales are tiny, huge")));
  EXPECT_THAT(errorWith(""), HasSubstr("it has no scales"));
}

TEST(BenchSuite, EachSweepHasItsTableOfThePaper) {
  const Suite suite = parseSuite(R"({"scenes": ["a"], "graphs": ["g"], "paper": "table1", "page": "paper",
    "sweeps": [{"name": "n"}, {"name": "m", "paper": "table2"}]})",
                                 "s.json");
  EXPECT_EQ(suite.papers, (std::map<std::string, std::string>{{"n", "table1"}, {"m", "table2"}}));
  EXPECT_EQ(suite.page, "paper");
}

TEST(BenchSuite, MatchKnowsWhatTheOtherGraphIsRunWith) {
  const Suite suite = parseSuite(
      R"({"scenes": ["a"], "set": {"kernel": "disc", "map_size": [16, 32]}, "sweeps": [{"name": "n", "graphs": [
    {"graph": "ours.json", "label": "o", "set": {"voxels": 64}, "warmup": 7},
    {"graph": "ir", "set": {"layout": "tiled"}, "match": {"like": "o", "from": 3, "to": 9}}]}]})",
      "s.json");
  ASSERT_EQ(suite.jobs.size(), 4u);
  ASSERT_TRUE(suite.jobs[3].match);
  EXPECT_EQ(suite.jobs[3].match->likeGraph, "ours.json");
  using Pair = std::pair<std::string, std::string>;
  EXPECT_THAT(suite.jobs[3].match->likeSet,
              ElementsAre(Pair("kernel", "disc"), Pair("map_size", "32"), Pair("voxels", "64")));
  EXPECT_EQ(suite.jobs[3].match->to, 9u);
  EXPECT_EQ(suite.jobs[3].match->likeWarmup, 7u);
  EXPECT_EQ(suite.jobs[3].warmup, 0u);
  EXPECT_EQ(suite.jobs[0].warmup, 7u);
}

struct Mistake {
  const char *name, *text, *message;
};

class BenchSuiteMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(BenchSuiteMistakes, AreLocated) {
  EXPECT_THAT(errorOf(GetParam().text), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, BenchSuiteMistakes,
    testing::Values(
        Mistake{"NotJson", "{", "s.json:1:2: error: not valid JSON"},
        Mistake{"NoSweeps", "{\n \"scenes\": []}", "s.json:1:1: error: a suite needs `sweeps` (at sweeps)"},
        Mistake{"UnknownKey", "{\"sweeps\": [],\n  \"scene\": [\"a\"]}",
                "s.json:2:3: error: unknown key `scene` (at scene)\n  -> did "
                "you mean `scenes`?"},
        Mistake{"UnknownKeyOfASweep",
                "{\"scenes\": [\"a\"], \"graphs\": [\"g\"], \"sweeps\": [\n "
                "{\"name\": \"n\", \"frame\": 3}]}",
                "s.json:2:16: error: unknown key `frame` (at "
                "sweeps[0].frame)\n  -> did you mean `frames`?"},
        Mistake{"UnknownMeasure",
                "{\"scenes\": [\"a\"], \"graphs\": [\"g\"],\n\"measures\": "
                "[\"eror\"], \"sweeps\": []}",
                "s.json:2:14: error: there is no measure `eror` (at "
                "measures)\n  -> did you mean `error`?"},
        Mistake{"UnknownMeasureOfEyes",
                "{\"scenes\": [\"a\"], \"graphs\": [\"g\"],\n\"measures\": "
                "[\"eye\"], \"sweeps\": []}",
                "s.json:2:14: error: there is no measure `eye` (at "
                "measures)\n  -> did you mean `eyes`?"},
        Mistake{"BadSize", "{\"size\": \"0x4\", \"sweeps\": []}",
                "s.json:1:10: error: expected a size like \"256x256\", 1 to "
                "16384 pixels a side, found the text \"0x4\" (at size)"},
        Mistake{"FramesOutOfRange", "{\"frames\": 0, \"sweeps\": []}", "s.json:1:12: error: "},
        Mistake{"SetOfObjects", "{\"set\": {\"vpl_count\": {}}, \"sweeps\": []}",
                "s.json:1:23: error: expected a value, or a list of values to "
                "go through, found an object (at set.vpl_count)"},
        Mistake{"NoScenes", "{\"graphs\": [\"g\"], \"sweeps\": [{\"name\": \"n\"}]}",
                "s.json:1:30: error: no `scenes`, neither here nor in the "
                "suite's head (at sweeps[0])"},
        Mistake{"NoName", "{\"scenes\": [\"a\"], \"graphs\": [\"g\"], \"sweeps\": [{}]}",
                "a sweep needs a `name`"},
        Mistake{"NameTwice",
                "{\"scenes\": [\"a\"], \"graphs\": [\"g\"], \"sweeps\": "
                "[{\"name\": \"n\"}, {\"name\": \"n\"}]}",
                "s.json:1:62: error: the sweep `n` occurs twice"},
        Mistake{"LabelTwice", "{\"graphs\": [\"g\", \"x/g.json\"], \"sweeps\": []}",
                "s.json:1:18: error: the label `g` occurs twice in this list "
                "(at graphs[1])"},
        Mistake{"UnknownKeyOfAScale", "{\"scales\": {\"small\":\n{\"seed\": 1}}, \"sweeps\": []}",
                "s.json:2:2: error: unknown key `seed` (at scales.small.seed)\n  -> did you mean `seeds`?"},
        Mistake{"BadSizeOfAScale", "{\"scales\": {\"small\": {\"size\": \"4\"}}, \"sweeps\": []}",
                "s.json:1:31: error: expected a size like \"256x256\", found the text \"4\" (at "
                "scales.small.size)"},
        Mistake{"ScaleOfOneFrame", "{\"scales\": {\"small\": {\"max_frames\": 1}}, \"sweeps\": []}",
                "expected a whole number from 2 to 1000000, found the number 1"},
        Mistake{"ScaleIsANumber", "{\"scales\": {\"small\": 4}, \"sweeps\": []}",
                "s.json:1:22: error: expected an object, found the number 4 (at scales.small)"},
        Mistake{"PageElsewhere", "{\"page\": \"../paper\", \"sweeps\": []}",
                "s.json:1:10: error: expected the name of a script in benchmarks/, without .py, found"},
        Mistake{"OneFrameHasNoChange",
                "{\"scenes\": [\"a\"], \"graphs\": [\"g\"], \"sweeps\": "
                "[{\"name\": \"n\", \"measures\": [\"temporal\"]}]}",
                "`frames` must be at least 2"},
        Mistake{"WarmupBeforeTheFirst",
                "{\"scenes\": [\"a\"], \"graphs\": [\"g\"], \"sweeps\": "
                "[{\"name\": \"n\", \"first\": 3, \"warmup\": 4}]}",
                "`warmup` frames come before frame `first`"},
        Mistake{"WarmupOfAGraphBeforeTheFirst",
                "{\"scenes\": [\"a\"], \"graphs\": [{\"graph\": \"g\", \"warmup\": 4}], \"sweeps\": "
                "[{\"name\": \"n\", \"first\": 3}]}",
                "`warmup` frames come before frame `first`"},
        Mistake{"MatchWithoutLike", "{\"graphs\": [{\"graph\": \"g\", \"match\": {}}], \"sweeps\": []}",
                "match needs `like`"},
        Mistake{"MatchUnknown",
                "{\"scenes\": [\"a\"], \"sweeps\": [{\"name\": \"n\", \"graphs\": "
                "[{\"graph\": \"g\", \"match\": {\"like\": \"h\"}}]}]}",
                "`like` names `h`, which is not another graph of this sweep"},
        Mistake{"SpeedUpUnknown",
                "{\"scenes\": [\"a\"], \"graphs\": [\"g\"], \"sweeps\": "
                "[{\"name\": \"n\", \"speed_up\": {\"of\": \"g\", \"over\": "
                "[\"h\"]}}]}",
                "`speed_up` names the graph `h`"}),
    [](const auto& info) { return info.param.name; });

TEST(BenchSuite, AllMistakesAtOnce) {
  const std::string all = errorOf("{\"size\": 3, \"frames\": -1, \"measure\": [], \"sweeps\": 1}");
  for (const char* part : {"s.json:1:10", "s.json:1:23", "unknown key `measure`", "`sweeps`"})
    EXPECT_THAT(all, HasSubstr(part));
}

TEST(BenchSuite, TheStockSuitesAreGood) {
  const std::filesystem::path folder = std::filesystem::path(FOVEA_SOURCE_DIR) / "benchmarks/suites";
  size_t suites = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().stem().string();
    const Suite suite = loadSuite(name, {folder});
    EXPECT_GT(suite.jobs.size(), 0u) << name;
    for (const std::string& scale : suite.scales)
      EXPECT_GT(loadSuite(name, {folder}, {.scale = scale}).jobs.size(), 0u) << name << ", " << scale;
    ++suites;
  }
  EXPECT_GE(suites, 9u);
  EXPECT_THROW(loadSuite("paepr", {folder}), Error);
}

// Whatever the scale, each table and figure has its sweeps, and the methods that it compares are measured.
TEST(BenchSuite, EveryScaleOfThePaperHasEveryTableAndFigure) {
  const std::filesystem::path folder = std::filesystem::path(FOVEA_SOURCE_DIR) / "benchmarks/suites";
  const auto measured = [](const Suite& suite) {
    std::set<std::string> found;
    for (const Job& job : suite.jobs) found.insert(job.sweep + " " + job.label);
    return found;
  };
  const std::set<std::string> all = measured(loadSuite("paper", {folder}));
  EXPECT_GE(all.size(), 20u);
  for (const char* scale : {"small", "middle", "full"})
    EXPECT_EQ(measured(loadSuite("paper", {folder}, {.scale = scale})), all) << scale;
}

TEST(BenchSuite, Globs) {
  EXPECT_TRUE(matchesGlob("ours", "stills-a-ours-s1"));
  EXPECT_FALSE(matchesGlob("theirs", "stills-a-ours-s1"));
  EXPECT_TRUE(matchesGlob("stills-*-s?", "stills-a-ours-s1"));
  EXPECT_FALSE(matchesGlob("stills-*-s?", "stills-a-ours-s12"));
  EXPECT_TRUE(matchesGlob("*", ""));
}

TEST(BenchSuite, ALayerOfItsOwnIsComparedAndPartOfTheKey) {
  const Suite suite = parseSuite(R"({"scenes": ["a"], "graphs": ["ours"],
    "sweeps": [{"name": "whole"}, {"name": "part", "layer": "indirect"}]})",
                                 "s.json");
  ASSERT_EQ(suite.jobs.size(), 2u);
  EXPECT_EQ(suite.jobs[0].layer, "radiance");
  EXPECT_FALSE(suite.jobs[0].json().contains("layer"));
  EXPECT_EQ(suite.jobs[1].layer, "indirect");
  EXPECT_EQ(suite.jobs[1].json()["layer"], "indirect");
  EXPECT_THROW(
      parseSuite(R"({"scenes": ["a"], "graphs": ["ours"], "layer": "albedo", "sweeps": [{"name": "n"}]})",
                 "s.json"),
      Error);
}

}  // namespace
}  // namespace fovea::bench
