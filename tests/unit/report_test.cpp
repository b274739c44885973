// Tests how a plan is reported to people, to programs and to the null device.
#include "framework/graph/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/base/json.h"
#include "framework/graph/report/traffic.h"
#include "framework/graph/verify/null_device.h"
#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

using testing::HasSubstr;

Compiled example() {
  return compileText(R"({"description": "An example", "passes": {
    "a": {"type": "source"},
    "unused": {"type": "filter", "inputs": {"image": "a"}},
    "b": {"type": "blend", "inputs": {"a": "a", "b": "b@previous"}},
    "h": {"type": "host", "inputs": {"image": "b"}}},
    "outputs": {"o": "h"}})");
}

TEST(Report, Text) {
  EXPECT_EQ(planText(example().plan),
            R"(graph graph: An example

order
  level 0
    layout  a.image: undefined -> general, transfer -> compute
    pass    a (source)
  level 1
    layout  a.image: general -> shader-read, compute -> compute
    layout  b.image@previous: transfer-source -> shader-read, compute+transfer -> compute
    layout  b.image: shader-read -> general, compute -> compute
    pass    b (blend)
  level 2
    layout  b.image: general -> transfer-source, compute -> transfer
    layout  h.image_out: undefined -> transfer-target, compute -> transfer
    pass    h (host), on the host
  end
    layout  h.image_out: transfer-target -> transfer-source, transfer -> transfer
  culled    unused (filter)

resources
  a.image      64x32 rgba16f                  16.0 KiB  transient, levels 0-1, heap 0 at 0 [sampled+storage write]
  b.image      64x32 rgba16f                  16.0 KiB  history [sampled+storage write+host read]
  h.image_out  64x32 rgba16f                  16.0 KiB  transient, levels 2-end, heap 0 at 0 [transfer read+host write]

outputs
  o            h.image_out

memory: transient 16.0 KiB (32.0 KiB without aliasing), kept 32.0 KiB
traffic: pictures 48 B a pixel (48.0 KiB read, 48.0 KiB written), all else 0 B read, 0 B written
)");
}

TEST(Report, DotHasANodeAPassAndAnEdgeAWire) {
  const std::string dot = planDot(example().plan);
  EXPECT_THAT(dot, HasSubstr("digraph \"graph\" {"));
  EXPECT_THAT(dot, HasSubstr("p0 [label=\"a\\nsource, level 0\"];"));
  EXPECT_THAT(dot, HasSubstr("p1 [label=\"unused\\nfilter, culled\", style=dashed"));
  EXPECT_THAT(dot, HasSubstr("p0 -> p2 [label=\"a.image\"];"));
  EXPECT_THAT(dot, HasSubstr("p2 -> p2 [label=\"b.image\", style=dashed, constraint=false];"));
  EXPECT_THAT(dot, HasSubstr("p3 -> \"output o\" [label=\"h.image_out\"];"));
}

TEST(Report, JsonHoldsTheSame) {
  const Compiled c = example();
  const json::Value v = json::parse(planJson(c.plan), "plan");
  EXPECT_EQ(v.find("graph")->string, "graph");
  ASSERT_EQ(v.find("levels")->items.size(), 3u);
  const json::Value& level = v.find("levels")->items[1];
  EXPECT_EQ(level.find("passes")->items[0].find("name")->string, "b");
  EXPECT_EQ(level.find("barriers")->find("images")->items.size(), 3u);
  EXPECT_EQ(v.find("culled")->items[0].string, "unused");
  EXPECT_EQ(v.find("resources")->items.size(), 3u);
  EXPECT_EQ(v.find("memory")->find("transient")->integer, 16384);
  EXPECT_EQ(v.find("memory")->find("transient_without_aliasing")->integer, 32768);
  EXPECT_EQ(v.find("outputs")->find("o")->string, "h.image_out");
  const json::Value& pictures = *level.find("passes")->items[0].find("traffic")->find("pictures");
  EXPECT_EQ(pictures.find("read")->integer, 2 * 16384);  // `a`, and its own of the last frame
  EXPECT_EQ(pictures.find("written")->integer, 16384);
  EXPECT_EQ(v.find("traffic")->find("pictures")->find("read")->integer, 3 * 16384);
  EXPECT_EQ(v.find("traffic")->find("picture_bytes_per_pixel")->real, 48);
}

// Buffers and arrays of images are no pictures: 10 VPLs of 64 bytes, 20 paths of 32, and 10 maps of 16x16 texels.
TEST(Report, TrafficOfBuffersAndLayersIsApart) {
  const Compiled c = compileText(R"({"passes": {
    "emit": {"type": "emit", "params": {"vpl_count": 10}},
    "atlas": {"type": "atlas", "inputs": {"vpls": "emit.vpls"}, "params": {"map_size": 16}}},
    "outputs": {"o": "atlas"}})");
  const std::vector<PassTraffic> list = traffic(c.plan);
  const PassTraffic &emit = list[c.pass("emit")], &atlas = list[c.pass("atlas")];
  EXPECT_EQ(emit.others.written, 10u * 64 + 20 * 32);
  EXPECT_EQ(emit.others.read, 0u);
  EXPECT_EQ(atlas.others.read, 10u * 64);
  EXPECT_EQ(atlas.others.written, 10u * 16 * 16 * 4);
  EXPECT_EQ(emit.pictures.total() + atlas.pictures.total(), 0u);
  EXPECT_EQ(outputPixels(*c.graph), 0u);
}

TEST(Report, InputsAndSubGraphNamesInDot) {
  const Compiled c = compileText(
      R"({"inputs": {"i": {"format": "rgba16f"}}, "passes": {"u": {"type": "update", "inputs": {"image": "inputs.i"}}}, "outputs": {"o": "u"}})");
  const std::string dot = planDot(c.plan);
  EXPECT_THAT(dot, HasSubstr("r0 [label=\"i\", shape=ellipse];"));
  EXPECT_THAT(dot, HasSubstr("r0 -> p0"));
}

TEST(Report, Sizes) {
  EXPECT_EQ(printBytes(12), "12 B");
  EXPECT_EQ(printBytes(1536), "1.5 KiB");
  EXPECT_EQ(printBytes(uint64_t(3) << 20), "3.0 MiB");
  EXPECT_EQ(printBytes(uint64_t(5) << 30), "5.00 GiB");
  ResourceDesc d;
  d.format = kDepth;
  d.width = d.height = 128;
  d.array = true;
  d.layers = 1000;
  d.mips = 3;
  EXPECT_EQ(describe(d), "128x128 x 1000 layers, 3 mips d32f");
}

TEST(NullDevice, ReplaysFramesInOrder) {
  const Compiled c = example();
  NullDevice device(c.plan);
  device.frame();
  device.frame();
  EXPECT_EQ(device.print(),
            "frame 0\n"
            "  barrier a.image[0]\n"
            "  pass a\n"
            "  barrier a.image[0]\n"
            "  barrier b.image[1]\n"
            "  barrier b.image[0]\n"
            "  pass b\n"
            "  barrier b.image[0]\n"
            "  barrier h.image_out[0]\n"
            "  pass h\n"
            "  barrier h.image_out[0]\n"
            "frame 1\n"
            "  barrier a.image[0]\n"
            "  pass a\n"
            "  barrier a.image[0]\n"
            "  barrier b.image[0]\n"  // the copies of the history image have changed places
            "  barrier b.image[1]\n"
            "  pass b\n"
            "  barrier b.image[1]\n"
            "  barrier h.image_out[0]\n"
            "  pass h\n"
            "  barrier h.image_out[0]\n");
  EXPECT_EQ(device.counters().frames, 2u);
  EXPECT_EQ(device.counters().passes, 6u);
  EXPECT_EQ(device.counters().hostPasses, 2u);
  EXPECT_EQ(device.counters().barrierCommands, 8u);
  EXPECT_EQ(device.counters().imageBarriers, 14u);
  EXPECT_EQ(device.counters().memoryBarriers, 0u);
}

TEST(NullDevice, CountsWithoutALog) {
  const Compiled c = example();
  NullDevice device(c.plan, false);
  for (int i = 0; i < 1000; ++i) device.frame();
  EXPECT_TRUE(device.events().empty());
  EXPECT_EQ(device.counters().passes, 3000u);
}

}  // namespace
}  // namespace fovea::graph::test
