// Tests reading resources back in the middle of a frame: the values are those of the resource, and reading changes
// nothing.
#include <gtest/gtest.h>

#include <cstring>

#include "framework/gpu/resources.h"
#include "framework/graph/run/execute.h"
#include "framework/scene/scene.h"
#include "framework/session/graph_run.h"
#include "framework/session/test_device.h"

namespace fovea::graph {
namespace {

constexpr const char* kGraph = R"({
  "passes": {
    "gbuffer": { "type": "gbuffer" },
    "shadow-map": { "type": "shadow-map", "params": { "size": 64 } },
    "direct": { "type": "direct", "inputs": { "gbuffer": "gbuffer", "maps": "shadow-map" } },
    "tonemap": { "type": "tonemap", "inputs": { "radiance": "direct" } }
  },
  "outputs": { "image": "tonemap", "radiance": "direct", "normal": "gbuffer.normal" }
})";

struct Running {
  scene::Scene scene = scene::builtin("cornellbox");
  scene::Geometry geometry = scene::flatten(scene);
  std::unique_ptr<session::GraphRun> run;

  explicit Running(const char* text, bool observable = true) {
    Diagnostics messages;
    const Description description = loadText(text, "test.json", {}, messages);
    session::GraphRun::Options options;
    options.size = {48, 32};
    options.observable = observable;
    options.framesInFlight = 2;
    options.readback = [](const BoundGraph& graph) {
      std::vector<std::string> names;
      for (const BoundOutput& output : graph.outputs) names.push_back(output.name);
      return names;
    };
    run = std::make_unique<session::GraphRun>(test::testDevice(), description, scene, geometry, options,
                                              messages);
    run->prepare();
  }
  FrameResult frame(uint64_t index, bool observe) {
    run->submit(run->frame(index), true, observe);
    return *run->executor().next();
  }
  Observation of(const std::string& name, const std::string& pass, const std::string& path) const {
    const BoundGraph& graph = run->graph();
    for (uint32_t p = 0; p < graph.passes.size(); ++p)
      if (graph.passes[p].name == pass) return {name, p, accessOf(graph.passes[p], path)};
    throw Error(ExitCode::Internal, "no pass " + pass);
  }
};

TEST(Observe, SeesWhatTheOutputsHold) {
  Running r(kGraph);
  const std::vector<Observation> all = {
      r.of("seen image", "tonemap", "image"), r.of("seen radiance", "direct", "direct"),
      r.of("seen normal", "gbuffer", "gbuffer.normal"), r.of("read normal", "direct", "gbuffer.normal")};
  r.run->executor().observe(all);
  for (uint64_t i = 0; i < 3; ++i) {
    const FrameResult frame = r.frame(i, true);
    EXPECT_EQ(frame.outputs.at("seen image").bytes, frame.outputs.at("image").bytes);
    EXPECT_EQ(frame.outputs.at("seen radiance").bytes, frame.outputs.at("radiance").bytes);
    EXPECT_EQ(frame.outputs.at("seen normal").bytes, frame.outputs.at("normal").bytes);
    EXPECT_EQ(frame.outputs.at("read normal").bytes, frame.outputs.at("normal").bytes);
    EXPECT_GT(frame.observeMs, 0);
    EXPECT_LT(frame.observeMs, frame.gpuMs);
  }
  const FrameResult without = r.frame(3, false);
  EXPECT_EQ(without.outputs.count("seen image"), 0u);
  EXPECT_EQ(without.observeMs, 0);
}

TEST(Observe, ChangesNothing) {
  Running seen(kGraph), plain(kGraph, false);
  seen.run->executor().observe(
      {seen.of("a", "gbuffer", "gbuffer.albedo"), seen.of("b", "shadow-map", "maps.depth")});
  const FrameResult a = seen.frame(0, true), b = plain.frame(0, false);
  for (const char* name : {"image", "radiance", "normal"})
    EXPECT_EQ(a.outputs.at(name).bytes, b.outputs.at(name).bytes) << name;
}

TEST(Observe, ReadsOneLayerAndTheBeginningOfABuffer) {
  Running r(kGraph);
  Observation depth = r.of("depth", "shadow-map", "maps.depth");
  const Observation views = r.of("views", "shadow-map", "maps.views");
  r.run->executor().observe({depth, views});
  const FrameResult frame = r.frame(0, true);
  const OutputData& layer = frame.outputs.at("depth");
  EXPECT_EQ(layer.desc.width, 64u);
  EXPECT_EQ(layer.desc.layers, 1u);
  EXPECT_EQ(layer.bytes.size(), 64u * 64 * 4);
  const OutputData& buffer = frame.outputs.at("views");
  EXPECT_EQ(buffer.bytes.size(), buffer.desc.stride * buffer.desc.count);
  depth.layer = 10000;
  EXPECT_THROW(r.run->executor().observe({depth}), Error);
}

TEST(Observe, RefusesWhatIsNotThere) {
  Running r(kGraph, false);
  EXPECT_THROW(r.run->executor().observe({r.of("a", "gbuffer", "gbuffer.albedo")}), Error);
  r.run->executor().observe({});
  EXPECT_EQ(r.frame(0, true).outputs.size(), 3u);
}

// As an image of a display is given one: the texels as they are, whatever its format makes of them.
TEST(OutputCopies, PutOutputsIntoLayersOfImagesOfOthers) {
  Running r(kGraph);
  const VkImageLayout layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  gpu::ImageDesc desc;
  desc.name = "display";
  desc.format = VK_FORMAT_R8G8B8A8_SRGB;
  desc.width = 48, desc.height = 32, desc.layers = 2;
  desc.usage =
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  gpu::Device& device = test::testDevice();
  gpu::Image display(device, desc);
  const size_t texels = size_t(48) * 32 * 4;
  gpu::upload(device, display, std::vector<std::byte>(2 * texels, std::byte{17}), layout);
  for (uint64_t i = 0; i < 3; ++i) {  // over the frames in flight
    const OutputCopy copies[] = {{"image", display.handle(), 0, layout},
                                 {"image", display.handle(), 1, layout}};
    r.run->submit(r.run->frame(i), true, false, copies);
    const FrameResult frame = *r.run->executor().next();
    std::vector<std::byte> twice = frame.outputs.at("image").bytes;
    ASSERT_EQ(twice.size(), texels);
    twice.insert(twice.end(), frame.outputs.at("image").bytes.begin(), frame.outputs.at("image").bytes.end());
    EXPECT_EQ(gpu::download(device, display, layout), twice) << i;
  }
}

TEST(OutputCopies, NameTheNearestOutputIfThereIsNone) {
  Running r(kGraph);
  const OutputCopy copies[] = {{"imag", VK_NULL_HANDLE}};
  try {
    r.run->submit(r.run->frame(0), false, false, copies);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean `image`?"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace fovea::graph
