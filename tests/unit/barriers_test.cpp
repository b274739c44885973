// Compares the barriers of small graphs with exact expectations, written in the words of graph_support.h.
#include "framework/graph/compile/barriers.h"

#include <gtest/gtest.h>

#include "framework/graph/pass/validate.h"
#include "framework/graph/verify/checker.h"
#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

// The barriers of each level, then those of the end. The checker must agree.
std::vector<std::string> barriersOf(const Compiled& c) {
  std::vector<std::string> lines;
  for (const Level& level : c.plan.levels) lines.push_back(barrierText(level.before, *c.graph));
  lines.push_back(barrierText(c.plan.end, *c.graph));
  EXPECT_EQ(checkPlan(c.plan), std::vector<std::string>{});
  return lines;
}

using Lines = std::vector<std::string>;
CompileOptions noAlias() {
  CompileOptions options;
  options.alias = false;
  return options;
}

TEST(Barriers, ImageWrittenAndSampled) {
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"}, "b": {"type": "filter", "inputs": {"image": "a"}}}, "outputs": {"o": "b"}})",
                                 noAlias());
  EXPECT_EQ(barriersOf(c),
            (Lines{// In the last frame `a` was sampled by compute: order only, contents discarded.
                   "a.image undefined > general compute:none > compute:write",
                   // In the last frame the output was read by a transfer.
                   "a.image general > sampled compute:write > compute:sampled; "
                   "b.image_out undefined > general transfer:none > compute:write",
                   "b.image_out general > source compute:write > transfer:transfer-read"}));
}

TEST(Barriers, BufferHazardsMergeIntoOneMemoryBarrier) {
  const Compiled c = compileText(R"({"passes": {
    "e": {"type": "emit"}, "d": {"type": "draw"},
    "s": {"type": "shade", "inputs": {"gbuffer": "d", "vpls": "e"}}}, "outputs": {"o": "s"}})",
                                 noAlias());
  EXPECT_EQ(barriersOf(c)[1].substr(0, 43), "memory compute:write > compute:uniform; d.g");
  // The scratch buffer is written in every frame, so the next write waits for the last one.
  EXPECT_EQ(barriersOf(c)[0].substr(0, 83),
            "memory color+compute:write+color-write > color+compute:write+color-read+color-write");
}

TEST(Barriers, AttachmentsOfAGBuffer) {
  const Compiled c = compileText(R"({"passes": {
    "d": {"type": "draw"}, "s": {"type": "shade", "inputs": {"gbuffer": "d"}}}, "outputs": {"o": "s"}})",
                                 noAlias());
  EXPECT_EQ(barriersOf(c),
            (Lines{// The normals are written and never read: the next frame's write flushes this one's.
                   "memory color:color-write > color:color-read+color-write; "
                   "d.gbuffer.position undefined > color compute:none > color:color-read+color-write; "
                   "d.gbuffer.normal undefined > color color:color-write > color:color-read+color-write; "
                   "d.gbuffer.depth undefined > depth compute:none > depth:depth-read+depth-write",
                   "d.gbuffer.position color > sampled color:color-write > compute:sampled; "
                   "d.gbuffer.depth depth > sampled depth:depth-write > compute:sampled; "
                   "s.image undefined > general transfer:none > compute:write",
                   "s.image general > source compute:write > transfer:transfer-read"}));
}

TEST(Barriers, AllReadersOfAVersionShareOneBarrier) {
  // Compute and the host read it in levels 1 and 2, so there is one barrier, before level 1.
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"},
    "b": {"type": "filter", "inputs": {"image": "a"}},
    "c": {"type": "blend", "inputs": {"a": "a", "b": "b"}}}, "outputs": {"o": "c"}})",
                                 noAlias());
  const Lines lines = barriersOf(c);
  EXPECT_NE(lines[1].find("a.image general > sampled"), std::string::npos);
  EXPECT_EQ(lines[2],
            "b.image_out general > sampled compute:write > compute:sampled; "
            "c.image undefined > general transfer:none > compute:write");
}

TEST(Barriers, ReadersThatWantDifferentLayoutsMeetInGeneral) {
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"},
    "b": {"type": "filter", "inputs": {"image": "a"}},
    "c": {"type": "storage-filter", "inputs": {"image": "a"}},
    "d": {"type": "blend", "inputs": {"a": "b", "b": "c"}}}, "outputs": {"o": "d"}})",
                                 noAlias());
  const BoundGraph& g = *c.graph;
  EXPECT_EQ(g.passes[c.pass("b")].accesses[0].layout, VK_IMAGE_LAYOUT_GENERAL);
  EXPECT_EQ(g.passes[c.pass("c")].accesses[0].layout, VK_IMAGE_LAYOUT_GENERAL);
  // The layout does not change, so one memory barrier serves both.
  EXPECT_EQ(barriersOf(c)[1].substr(0, 53), "memory compute:write > compute:sampled+read; b.image_");
}

TEST(Barriers, HistoryCopiesChangePlaces) {
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"},
    "b": {"type": "blend", "inputs": {"a": "a", "b": "b@previous"}}}, "outputs": {"o": "b"}})",
                                 noAlias());
  EXPECT_EQ(barriersOf(c),
            (Lines{"a.image undefined > general compute:none > compute:write",
                   // Last frame's output was left for the transfer; the copy before it was sampled last.
                   "a.image general > sampled compute:write > compute:sampled; "
                   "b.image@previous source > sampled compute+transfer:write > compute:sampled; "
                   "b.image sampled > general compute:none > compute:write",
                   "b.image general > source compute:write > transfer:transfer-read"}));
  const uint32_t r = c.resource("b.image");
  EXPECT_EQ(c.plan.startLayout[r][0], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  EXPECT_EQ(c.plan.startLayout[r][1], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  EXPECT_EQ(c.plan.endLayout[r], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

TEST(Barriers, KeptContentsAreNeverDiscarded) {
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"}, "k": {"type": "keep", "inputs": {"image": "a"}},
    "f": {"type": "filter", "inputs": {"image": "k"}}}, "outputs": {"o": "f"}})",
                                 noAlias());
  const Lines lines = barriersOf(c);
  EXPECT_EQ(lines[1],
            "a.image general > sampled compute:write > compute:sampled; "
            "k.sum sampled > general compute:write > compute:read+write");
  const uint32_t r = c.resource("k.sum");
  EXPECT_EQ(c.plan.startLayout[r][0], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  EXPECT_EQ(c.plan.endLayout[r], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

TEST(Barriers, UpdateInPlaceSeesTheWriteAndWaitsForReaders) {
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"},
    "r": {"type": "storage-filter", "inputs": {"image": "a"}},
    "u": {"type": "update", "inputs": {"image": "a"}},
    "e": {"type": "blend", "inputs": {"a": "r", "b": "u"}}}, "outputs": {"o": "e"}})",
                                 noAlias());
  EXPECT_EQ(c.order(), "a | r | u | e");
  // The layout is the same throughout, so there are only memory barriers.
  EXPECT_EQ(barriersOf(c)[2], "memory compute:write > compute:read+write");
}

TEST(Barriers, MemoryTakenOverWaitsForItsLastOccupant) {
  // c.image_out lies where a.image was; only b's reads of a have to be waited for.
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"},
    "b": {"type": "filter", "inputs": {"image": "a"}},
    "c": {"type": "filter", "inputs": {"image": "b"}},
    "d": {"type": "filter", "inputs": {"image": "c"}}}, "outputs": {"o": "d"}})");
  ASSERT_EQ(c.placement("a.image").offset, c.placement("c.image_out").offset);
  ASSERT_EQ(c.placement("b.image_out").offset, c.placement("d.image_out").offset);
  EXPECT_EQ(barriersOf(c),
            (Lines{// c's memory of the last frame, which d sampled.
                   "a.image undefined > general compute:none > compute:write",
                   // d's memory of the last frame, which the readback read.
                   // NOLINTNEXTLINE(bugprone-suspicious-missing-comma): two changes before one level
                   "a.image general > sampled compute:write > compute:sampled; "
                   "b.image_out undefined > general transfer:none > compute:write",
                   "b.image_out general > sampled compute:write > compute:sampled; "
                   "c.image_out undefined > general compute:none > compute:write",
                   "c.image_out general > sampled compute:write > compute:sampled; "
                   "d.image_out undefined > general compute:none > compute:write",
                   "d.image_out general > source compute:write > transfer:transfer-read"}));
}

TEST(Barriers, HostPassesAreTransfers) {
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"}, "h": {"type": "host", "inputs": {"image": "a"}},
    "f": {"type": "filter", "inputs": {"image": "h"}}}, "outputs": {"o": "f"}})",
                                 noAlias());
  const Lines lines = barriersOf(c);
  EXPECT_EQ(lines[1],
            "a.image general > source compute:write > transfer:transfer-read; "
            "h.image_out undefined > target compute:none > transfer:transfer-write");
  EXPECT_EQ(lines[2].substr(0, 78),
            "h.image_out target > sampled transfer:transfer-write > compute:sampled; f.imag");
}

TEST(Barriers, AnInputThatIsOnlyReadNeedsNone) {
  const Compiled c = compileText(
      R"({"inputs": {"i": {"format": "rgba16f"}, "v": {"element": "Vpl", "stride": 64, "count": 9}},
    "passes": {"f": {"type": "filter", "inputs": {"image": "inputs.i"}}}, "outputs": {"o": "f"}})",
      noAlias());
  EXPECT_EQ(barriersOf(c)[0], "f.image_out undefined > general transfer:none > compute:write");
  EXPECT_EQ(c.plan.startLayout[c.resource("i")][0], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

TEST(Barriers, AnInputUpdatedInPlaceGoesRoundTheFrame) {
  const Compiled c = compileText(R"({"inputs": {"i": {"format": "rgba16f"}},
    "passes": {"u": {"type": "update", "inputs": {"image": "inputs.i"}}}, "outputs": {"o": "u"}})",
                                 noAlias());
  EXPECT_EQ(barriersOf(c), (Lines{"i source > general compute+transfer:write > compute:read+write",
                                  "i general > source compute:write > transfer:transfer-read"}));
}

TEST(AccessScope, LayoutsOfCombinedUsages) {
  auto layout = [](Usage usage, bool writes) {
    return layoutText(accessScope(PassKind::ComputeAndGraphics, usage, true, writes).layout);
  };
  EXPECT_EQ(layout(Usage::Sampled, false), "sampled");
  EXPECT_EQ(layout(Usage::Sampled | Usage::StorageRead, false), "general");
  EXPECT_EQ(layout(Usage::StorageWrite, true), "general");
  EXPECT_EQ(layout(Usage::ColorAttachment, true), "color");
  EXPECT_EQ(layout(Usage::ColorAttachment | Usage::Sampled, true), "general");
  EXPECT_EQ(layout(Usage::DepthAttachment, true), "depth");
  EXPECT_EQ(layout(Usage::DepthAttachment, false), "depth-read");
  EXPECT_EQ(layout(Usage::DepthAttachment | Usage::Sampled, false), "depth-read");
  EXPECT_EQ(layout(Usage::DepthAttachment | Usage::Sampled, true), "general");
  EXPECT_EQ(layout(Usage::TransferRead, false), "source");
  EXPECT_EQ(layout(Usage::TransferWrite, true), "target");
  EXPECT_EQ(layout(Usage::TransferWrite | Usage::StorageWrite, true), "general");
}

TEST(AccessScope, StagesFollowFromThePassKind) {
  auto stage = [](PassKind kind, Usage usage) {
    return stageText(accessScope(kind, usage, true, false).stage);
  };
  EXPECT_EQ(stage(PassKind::Compute, Usage::Sampled), "compute");
  EXPECT_EQ(stage(PassKind::Graphics, Usage::Uniform), "vertex+fragment");
  EXPECT_EQ(stage(PassKind::ComputeAndGraphics, Usage::TexelRead), "vertex+fragment+compute");
  EXPECT_EQ(stage(PassKind::Compute, Usage::Indirect), "indirect");
  EXPECT_EQ(stage(PassKind::Graphics, Usage::DepthAttachment), "depth");
  EXPECT_EQ(stage(PassKind::Host, Usage::HostRead), "transfer");
  EXPECT_EQ(stage(PassKind::Compute, Usage::TransferRead), "transfer");
}

}  // namespace
}  // namespace fovea::graph::test
