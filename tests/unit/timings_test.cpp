// Tests that the times of frames come back as they were given, whatever passes and steps each frame has.
#include "framework/session/timings.h"

#include <gtest/gtest.h>

namespace fovea::session {
namespace {

graph::FrameResult frameOf(uint64_t number, const std::vector<std::string>& steps,
                           const std::string& counter) {
  const auto n = double(number);
  graph::FrameResult frame;
  frame.frame = number;
  frame.gpuMs = n + 0.1, frame.cpuMs = n + 0.2, frame.wallMs = n + 0.3;
  frame.passes = {{0, n + 0.4, n + 0.5, {}}, {2, n + 0.6, n + 0.7, {}}};
  for (const std::string& step : steps) frame.passes[1].steps.push_back({step, n + double(step.size())});
  frame.counters = {{counter, n * 1e15}};
  frame.outputs["image"].bytes.resize(8);
  return frame;
}

void expectSame(const graph::FrameResult& a, const graph::FrameResult& b) {
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.gpuMs, b.gpuMs);
  EXPECT_EQ(a.cpuMs, b.cpuMs);
  EXPECT_EQ(a.wallMs, b.wallMs);
  ASSERT_EQ(a.passes.size(), b.passes.size());
  for (size_t i = 0; i < a.passes.size(); ++i) {
    EXPECT_EQ(a.passes[i].pass, b.passes[i].pass);
    EXPECT_EQ(a.passes[i].gpuMs, b.passes[i].gpuMs);
    EXPECT_EQ(a.passes[i].cpuMs, b.passes[i].cpuMs);
    ASSERT_EQ(a.passes[i].steps.size(), b.passes[i].steps.size());
    for (size_t s = 0; s < a.passes[i].steps.size(); ++s) {
      EXPECT_EQ(a.passes[i].steps[s].name, b.passes[i].steps[s].name);
      EXPECT_EQ(a.passes[i].steps[s].gpuMs, b.passes[i].steps[s].gpuMs);
    }
  }
  EXPECT_EQ(a.counters, b.counters);
}

TEST(Timings, GivesBackWhatItWasGiven) {
  const std::vector<graph::FrameResult> given = {
      frameOf(7, {"sweep", "sum"}, "vpls"), frameOf(8, {"sweep", "sum"}, "vpls"), frameOf(9, {"sum"}, "vpls"),
      frameOf(10, {}, "rays"), frameOf(11, {"sweep", "sum"}, "vpls")};
  Timings timings(nullptr);
  EXPECT_TRUE(timings.empty());
  for (const graph::FrameResult& frame : given) timings.add(frame);
  EXPECT_FALSE(timings.empty());
  size_t count = 0;
  timings.eachFrame([&](const graph::FrameResult& frame) {
    ASSERT_LT(count, given.size());
    expectSame(frame, given[count++]);
    EXPECT_TRUE(frame.outputs.empty());
  });
  EXPECT_EQ(count, given.size());
}

// The vertices that move are a pass of their own, before the others.
TEST(Timings, AnimationComesFirst) {
  graph::FrameResult frame = frameOf(1, {}, "vpls");
  frame.animateMs = 3, frame.animateCpuMs = 4;
  Timings timings(nullptr);
  timings.add(frame);
  timings.eachFrame([&](const graph::FrameResult& shown) {
    ASSERT_EQ(shown.passes.size(), 3u);
    EXPECT_EQ(timings.name(shown.passes[0].pass), "animate");
    EXPECT_EQ(shown.passes[0].gpuMs, 3);
    EXPECT_EQ(shown.passes[0].cpuMs, 4);
  });
}

}  // namespace
}  // namespace fovea::session
