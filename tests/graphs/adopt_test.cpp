// Tests a graph that is edited while it runs: everything that the edit did not change continues, bit for bit.
#include <gtest/gtest.h>

#include "framework/scene/scene.h"
#include "framework/session/graph_run.h"
#include "framework/session/test_device.h"
#include "places.h"

namespace fovea::graph {
namespace {

class Edited {
 public:
  Edited() : scene_(scene::builtin("cornellbox")), geometry_(scene::flatten(scene_)) {}

  // Replaces the graph that runs.
  void run(const std::string& graph, const std::vector<std::string>& set, bool keepContents = true) {
    LoadOptions options;
    options.searchPaths = {std::filesystem::path(FOVEA_SOURCE_DIR) / "graphs"};
    for (const std::string& text : set) options.overrides.push_back(parseOverride(text));
    Diagnostics messages;
    const Description description = load(graph, options, messages);
    session::GraphRun::Options chosen;
    chosen.size = {48, 48};
    chosen.observable = true;
    chosen.framesInFlight = 2;  // as on a GPU, where the copies of a history take turns among two slots
    chosen.readback = [](const BoundGraph&) { return std::vector<std::string>{"radiance"}; };
    auto next = std::make_unique<session::GraphRun>(test::testDevice(), description, scene_, geometry_,
                                                    chosen, messages);
    next->prepare(run_.get(), keepContents);
    run_ = std::move(next);
  }
  std::vector<std::byte> frame() {
    run_->submit(run_->frame(index_++), true);
    return run_->executor().next()->outputs.at("radiance").bytes;
  }
  void restart() { index_ = 0; }
  void skip(int count) {
    for (int i = 0; i < count; ++i) frame();
  }

 private:
  scene::Scene scene_;
  scene::Geometry geometry_;
  std::unique_ptr<session::GraphRun> run_;
  uint64_t index_ = 0;
};

constexpr const char* kFew = "vpl_count=64";

class Adopt : public testing::TestWithParam<const char*> {};

// The tone curve has no part in the radiance, which must not notice.
TEST_P(Adopt, WhatIsUntouchedGoesOn) {
  Edited edited, plain;
  edited.run(GetParam(), {kFew});
  plain.run(GetParam(), {kFew});
  for (int round = 0; round < 3; ++round) {
    edited.skip(round + 1);
    plain.skip(round + 1);
    edited.run(GetParam(), {kFew, round % 2 ? "tonemap.exposure=2" : "tonemap.exposure=3"});
    EXPECT_EQ(edited.frame(), plain.frame()) << "round " << round;
  }
}
INSTANTIATE_TEST_SUITE_P(Graphs, Adopt, testing::Values("ours", "debug/ir_accumulated", "foveal"));

TEST(AdoptNot, ARestartBeginsAnew) {
  Edited edited, plain;
  edited.run("ours", {kFew});
  edited.skip(3);
  edited.run("ours", {kFew}, false);
  edited.restart();
  plain.run("ours", {kFew});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(edited.frame(), plain.frame()) << i;
}

// Another number of VPLs makes other buffers; those of the old size are not taken.
TEST(AdoptNot, OtherSizesBeginAnew) {
  Edited edited;
  edited.run("ours", {kFew});
  edited.skip(3);
  edited.run("ours", {"vpl_count=80"});
  edited.skip(2);
  edited.run("ours", {kFew});
  EXPECT_NO_THROW(edited.skip(2));
  edited.run("direct", {});
  EXPECT_NO_THROW(edited.skip(2));
  edited.run("ours", {kFew});
  EXPECT_NO_THROW(edited.skip(2));
}

TEST(AdoptNot, AFailedEditLeavesTheGraphAlone) {
  Edited edited, plain;
  edited.run("ours", {kFew});
  plain.run("ours", {kFew});
  edited.skip(2);
  plain.skip(2);
  EXPECT_THROW(edited.run("ours", {"vpl_count=-1"}), Error);
  EXPECT_EQ(edited.frame(), plain.frame());
}

}  // namespace
}  // namespace fovea::graph
