// Tests the aliasing of memory: exact offsets on small examples, and the rules about what may share memory.
#include "framework/graph/compile/alias.h"

#include <gtest/gtest.h>

#include "framework/gpu/format.h"
#include "tests/unit/graph_support.h"

namespace fovea::graph::test {
namespace {

AliasRequest request(uint32_t resource, uint32_t first, uint32_t last, uint64_t bytes, uint64_t alignment = 1,
                     uint32_t types = ~0u) {
  return {resource, {first, last}, {bytes, alignment, types}};
}

std::vector<uint64_t> offsets(const std::vector<AliasRequest>& requests, uint64_t granularity = 1,
                              bool alias = true) {
  std::vector<uint64_t> result;
  for (const Placement& p : placeResources(requests, granularity, alias).placements)
    result.push_back(p.offset);
  return result;
}

using Offsets = std::vector<uint64_t>;

TEST(EstimateMemory, TexelsHaveTheSizeOfTheirFormat) {
  for (const gpu::FormatInfo& info : gpu::formats()) {
    ResourceDesc desc;
    desc.format = info.format;
    desc.width = desc.height = 16;
    EXPECT_EQ(estimateMemory(desc).bytes, 256u * info.bytesPerTexel) << info.name;
  }
}

TEST(Alias, DisjointLivesShare) {
  EXPECT_EQ(offsets({request(0, 0, 1, 100), request(1, 2, 3, 100), request(2, 4, 5, 60)}),
            (Offsets{0, 0, 0}));
}

TEST(Alias, LivesThatMeetInALevelDoNotShare) {
  EXPECT_EQ(offsets({request(0, 0, 1, 100), request(1, 1, 2, 100), request(2, 2, 3, 100)}),
            (Offsets{0, 100, 0}));
}

TEST(Alias, LargestFirst) {
  // The large one takes the bottom although it is created last.
  EXPECT_EQ(offsets({request(0, 0, 2, 10), request(1, 1, 3, 1000)}), (Offsets{1000, 0}));
}

TEST(Alias, TightestGap) {
  // At levels 2 and 3 there are gaps of 300 (at 0) and 240 (at 550); 90 bytes go into the tighter one.
  const std::vector<AliasRequest> requests = {request(0, 0, 1, 300), request(1, 0, 3, 250),
                                              request(2, 0, 1, 240), request(3, 0, 3, 230),
                                              request(4, 2, 3, 90)};
  // 0: [0,300) 1: [300,550) 2: [550,790) 3: [790,1020); 4: gaps at level 2-3 are [0,300) and [550,790).
  EXPECT_EQ(offsets(requests), (Offsets{0, 300, 550, 790, 550}));
}

TEST(Alias, EqualGapsGoToTheLowerOffset) {
  EXPECT_EQ(offsets({request(0, 0, 1, 100), request(1, 0, 3, 100), request(2, 0, 1, 100),
                     request(3, 0, 3, 100), request(4, 2, 3, 50)}),
            (Offsets{0, 100, 200, 300, 0}));
}

TEST(Alias, AlignmentAndGranularity) {
  EXPECT_EQ(offsets({request(0, 0, 1, 100), request(1, 0, 1, 50, 64)}), (Offsets{0, 128}));
  EXPECT_EQ(offsets({request(0, 0, 1, 100), request(1, 0, 1, 50)}, 1024), (Offsets{0, 1024}));
  const AliasResult r = placeResources(std::vector<AliasRequest>{request(0, 0, 1, 100, 64)}, 1, true);
  EXPECT_EQ(r.placements[0].bytes, 128u);
  EXPECT_EQ(r.heaps[0].bytes, 128u);
}

TEST(Alias, OneHeapPerSetOfMemoryTypes) {
  const AliasResult r =
      placeResources(std::vector<AliasRequest>{request(0, 0, 1, 100, 1, 3), request(1, 2, 3, 100, 1, 5),
                                               request(2, 2, 3, 100, 1, 3)},
                     1, true);
  ASSERT_EQ(r.heaps.size(), 2u);
  EXPECT_EQ(r.heaps[0].memoryTypeBits, 3u);
  EXPECT_EQ(r.heaps[1].memoryTypeBits, 5u);
  EXPECT_EQ(r.placements[0].heap, 0u);
  EXPECT_EQ(r.placements[1].heap, 1u);
  EXPECT_EQ(r.placements[2].heap, 0u);
  EXPECT_EQ(r.bytesAliased, 200u);
  EXPECT_EQ(r.bytesUnaliased, 300u);
}

TEST(Alias, OffMeansOff) {
  const std::vector<AliasRequest> requests = {request(0, 0, 1, 100), request(1, 2, 3, 100)};
  EXPECT_EQ(offsets(requests, 1, false), (Offsets{0, 100}));
  EXPECT_EQ(placeResources(requests, 1, false).bytesAliased, 200u);
}

TEST(Alias, NothingToPlace) { EXPECT_TRUE(placeResources({}, 1, true).heaps.empty()); }

TEST(Alias, ChainNeedsTwoImages) {
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"},
    "b": {"type": "filter", "inputs": {"image": "a"}},
    "c": {"type": "filter", "inputs": {"image": "b"}},
    "d": {"type": "filter", "inputs": {"image": "c"}},
    "e": {"type": "filter", "inputs": {"image": "d"}}},
    "outputs": {"o": "e"}})");
  const uint64_t one = 64 * 32 * 8;
  EXPECT_EQ(c.plan.bytesUnaliased, 5 * one);
  EXPECT_EQ(c.plan.bytesAliased, 2 * one);
  EXPECT_EQ(c.placement("a.image").offset, 0u);
  EXPECT_EQ(c.placement("b.image_out").offset, one);
  EXPECT_EQ(c.placement("c.image_out").offset, 0u);
  EXPECT_EQ(c.placement("d.image_out").offset, one);
  EXPECT_EQ(c.placement("e.image_out").offset, 0u);
}

TEST(Alias, KeptHistoryAndExternalNeverShare) {
  const Compiled c = compileText(R"({
    "inputs": {"given": {"format": "rgba16f", "width": 8, "height": 8}},
    "passes": {
      "k": {"type": "keep", "inputs": {"image": "inputs.given"}},
      "h": {"type": "blend", "inputs": {"a": "k", "b": "h@previous"}},
      "e": {"type": "filter", "inputs": {"image": "h"}}},
    "outputs": {"o": "e"}})");
  ASSERT_EQ(c.plan.placements.size(), 1u);
  EXPECT_EQ(c.graph->resources[c.plan.placements[0].resource].name, "e.image_out");
  // The kept image counts once, the history twice.
  EXPECT_EQ(c.plan.bytesKept, 3u * 64 * 32 * 8);
}

TEST(Alias, OutputsStayToTheEnd) {
  // `a` is an output, so nothing later takes its memory.
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"},
    "b": {"type": "filter", "inputs": {"image": "a"}},
    "c": {"type": "filter", "inputs": {"image": "b"}},
    "d": {"type": "filter", "inputs": {"image": "c"}}},
    "outputs": {"first": "a", "o": "d"}})");
  const uint64_t one = 64 * 32 * 8;
  EXPECT_EQ(c.plan.bytesAliased, 3 * one);
  for (const char* other : {"b.image_out", "c.image_out", "d.image_out"})
    EXPECT_NE(c.placement("a.image").offset, c.placement(other).offset) << other;
}

}  // namespace
}  // namespace fovea::graph::test
