// The checker must find defects: sound plans are broken on purpose, one way at a time.
#include "framework/graph/verify/checker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/random_graph.h"

namespace fovea::graph::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// A plan with everything that one can hold: buffers and images, history, kept resources, updates in
// place, aliasing, attachments.
Compiled richPlan() {
  return compileText(R"({"passes": {
    "emit": {"type": "emit"},
    "draw": {"type": "draw"},
    "shade": {"type": "shade", "inputs": {"gbuffer": "draw", "vpls": "emit"}},
    "sum": {"type": "keep", "inputs": {"image": "shade"}},
    "mix": {"type": "blend", "inputs": {"a": "sum", "b": "mix@previous"}},
    "f": {"type": "filter", "inputs": {"image": "mix"}},
    "u": {"type": "update", "inputs": {"image": "f"}},
    "g": {"type": "storage-filter", "inputs": {"image": "u"}},
    "h": {"type": "host", "inputs": {"image": "g"}},
    "end": {"type": "filter", "inputs": {"image": "h"}}},
    "outputs": {"image": "end", "mix": "mix"}})");
}

// A plan with buffers only, because layouts could give a broken plan away.
Compiled bufferPlan(bool alias = true) {
  auto registry = std::make_shared<Registry>();
  PassDeclaration make("make", "Makes");
  make.output("items", buffer("Item", 16, 64), Usage::StorageWrite, "made");
  registry->add(make, nullptr);
  PassDeclaration step("step", "Reads and makes");
  step.input("items", buffer("Item", 16), Usage::StorageRead, "read");
  step.output("out", buffer("Item", 16, 64), Usage::StorageWrite, "made");
  registry->add(step, nullptr);
  Compiled c;
  c.registry = registry;
  c.graph = bindText(R"({"passes": {"a": {"type": "make"}, "b": {"type": "step", "inputs": {"items": "a"}},
    "c": {"type": "step", "inputs": {"items": "b"}}, "d": {"type": "step", "inputs": {"items": "c"}}},
    "outputs": {"o": "d"}})",
                     *registry, c.messages);
  CompileOptions options;
  options.alias = alias;
  c.plan = compile(c.graph, options);
  return c;
}

TEST(Checker, SoundPlansPass) {
  EXPECT_THAT(checkPlan(richPlan().plan), IsEmpty());
  EXPECT_THAT(checkPlan(bufferPlan().plan), IsEmpty());
}

TEST(Checker, EveryImageBarrierIsNeeded) {
  const Compiled c = richPlan();
  size_t removed = 0;
  for (size_t l = 0; l <= c.plan.levels.size(); ++l) {
    const size_t count = (l < c.plan.levels.size() ? c.plan.levels[l].before : c.plan.end).images.size();
    for (size_t i = 0; i < count; ++i, ++removed) {
      Plan broken = c.plan;
      BarrierBatch& batch = l < c.plan.levels.size() ? broken.levels[l].before : broken.end;
      batch.images.erase(batch.images.begin() + static_cast<ptrdiff_t>(i));
      EXPECT_THAT(checkPlan(broken), Not(IsEmpty())) << "level " << l << ", barrier " << i;
    }
  }
  EXPECT_GE(removed, 15u);
}

TEST(Checker, EveryMemoryBarrierOfABufferChainIsNeeded) {
  for (const bool alias : {true, false}) {
    const Compiled c = bufferPlan(alias);
    // With memory of its own, the first write is also ordered by the barriers of last frame's later levels.
    for (size_t l = alias ? 0 : 1; l < c.plan.levels.size(); ++l) {
      ASSERT_NE(c.plan.levels[l].before.srcStage, 0u);
      Plan broken = c.plan;
      broken.levels[l].before = {};
      EXPECT_THAT(checkPlan(broken), Not(IsEmpty())) << "level " << l;
    }
    Plan broken = c.plan;
    broken.end = {};
    EXPECT_THAT(checkPlan(broken), Contains(HasSubstr("readback")));
  }
}

TEST(Checker, EveryScopeOfTheMemoryBarriersIsNeeded) {
  const Compiled c = bufferPlan();
  for (size_t l = 1; l < c.plan.levels.size(); ++l) {
    for (int field = 0; field < 4; ++field) {
      Plan broken = c.plan;
      BarrierBatch& b = broken.levels[l].before;
      if (field == 0) b.srcStage = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
      if (field == 1) b.srcAccess = 0;
      if (field == 2) b.dstStage = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
      if (field == 3) b.dstAccess = VK_ACCESS_2_UNIFORM_READ_BIT;
      EXPECT_THAT(checkPlan(broken), Not(IsEmpty())) << "level " << l << ", field " << field;
    }
  }
}

TEST(Checker, EveryScopeOfTheImageBarriersIsNeeded) {
  const Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"}, "b": {"type": "filter", "inputs": {"image": "a"}},
    "c": {"type": "blend", "inputs": {"a": "b", "b": "c@previous"}}}, "outputs": {"o": "c"}})");
  for (size_t l = 0; l < c.plan.levels.size(); ++l) {
    for (size_t i = 0; i < c.plan.levels[l].before.images.size(); ++i) {
      for (int field = 0; field < 5; ++field) {
        Plan broken = c.plan;
        ImageBarrier& b = broken.levels[l].before.images[i];
        const bool discards = b.oldLayout == VK_IMAGE_LAYOUT_UNDEFINED;
        if (field == 0) b.srcStage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
        if (field == 1 && b.srcAccess == 0) continue;
        if (field == 1 && b.previous) continue;  // flushed for the readback before
        if (field == 1) b.srcAccess = 0;
        if (field == 2) b.dstStage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
        if (field == 3 && b.newLayout == VK_IMAGE_LAYOUT_GENERAL) continue;  // a write needs no visibility
        if (field == 3) b.dstAccess = VK_ACCESS_2_UNIFORM_READ_BIT;
        if (field == 4 && discards) continue;
        if (field == 4) b.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        const bool harmless =
            field == 4 && b.newLayout == VK_IMAGE_LAYOUT_GENERAL;  // fully overwritten anyway
        if (harmless)
          EXPECT_THAT(checkPlan(broken), IsEmpty());
        else
          EXPECT_THAT(checkPlan(broken), Not(IsEmpty()))
              << "level " << l << ", barrier " << i << ", field " << field;
      }
    }
  }
}

TEST(Checker, WrongLayouts) {
  const Compiled c = richPlan();
  for (size_t l = 0; l < c.plan.levels.size(); ++l) {
    for (size_t i = 0; i < c.plan.levels[l].before.images.size(); ++i) {
      Plan broken = c.plan;
      ImageBarrier& b = broken.levels[l].before.images[i];
      b.newLayout = b.newLayout == VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL
                        ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
                        : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
      EXPECT_THAT(checkPlan(broken), Contains(HasSubstr("layout"))) << l << " " << i;
    }
  }
  Plan broken = c.plan;
  const uint32_t mix = c.resource("mix.image");
  std::swap(broken.startLayout[mix][0], broken.startLayout[mix][1]);
  EXPECT_THAT(checkPlan(broken), Contains(HasSubstr("starts the frame in layout")));
  broken = c.plan;
  broken.endLayout[mix] = VK_IMAGE_LAYOUT_GENERAL;
  EXPECT_THAT(checkPlan(broken), Contains(HasSubstr("ends the frame in layout")));
}

TEST(Checker, OverlappingMemory) {
  // With every transient at the bottom of its heap, resources that live at the same time overwrite each other.
  Compiled c = bufferPlan();
  for (Placement& p : c.plan.placements) p.offset = 0;
  EXPECT_THAT(checkPlan(c.plan), Contains(HasSubstr("`b.out` takes memory of `a.items` without waiting")));
  // A value that must outlive the level is gone when it is read.
  Compiled d =
      compileText(R"({"passes": {"a": {"type": "source"}, "b": {"type": "filter", "inputs": {"image": "a"}},
    "c": {"type": "blend", "inputs": {"a": "a", "b": "b"}}}, "outputs": {"o": "c"}})");
  for (Placement& p : d.plan.placements) p.offset = 0;
  EXPECT_THAT(checkPlan(d.plan), Contains(HasSubstr("`c` reads `a.image`, which holds nothing")));
}

TEST(Checker, MemoryTakenWithoutWaiting) {
  // The plan was made for separate memory; then the offsets are made to overlap.
  Compiled apart = bufferPlan(false);
  const Compiled shared = bufferPlan(true);
  EXPECT_THAT(checkPlan(apart.plan), IsEmpty());
  apart.plan.placements = shared.plan.placements;
  apart.plan.heaps = shared.plan.heaps;
  // Level 0 does not wait for the previous user of the memory.
  apart.plan.levels[0].before = {};
  EXPECT_THAT(checkPlan(apart.plan), Contains(HasSubstr("takes memory of")));
}

TEST(Checker, PlacesThatDoNotFit) {
  const Compiled c = bufferPlan();
  auto with = [&](auto change) {
    Plan broken = c.plan;
    change(broken);
    return checkPlan(broken);
  };
  EXPECT_THAT(with([](Plan& p) { p.placements[0].bytes -= 1; }), Contains(HasSubstr("needs 1024")));
  EXPECT_THAT(with([](Plan& p) { p.placements[1].offset += 1; }), Contains(HasSubstr("misaligned")));
  EXPECT_THAT(with([](Plan& p) { p.heaps[0].bytes -= 1; }), Contains(HasSubstr("past its heap")));
  EXPECT_THAT(with([](Plan& p) { p.placements.pop_back(); }), Contains(HasSubstr("has 0 places")));
  EXPECT_THAT(with([](Plan& p) { p.placements.push_back(p.placements[0]); }),
              Contains(HasSubstr("has 2 places")));
}

TEST(Checker, PassesInTheWrongOrder) {
  const Compiled c = richPlan();
  for (size_t l = 0; l + 1 < c.plan.levels.size(); ++l) {
    Plan broken = c.plan;
    std::swap(broken.levels[l].passes, broken.levels[l + 1].passes);
    EXPECT_THAT(checkPlan(broken), Not(IsEmpty())) << l;
    broken = c.plan;  // both in one level
    auto& into = broken.levels[l].passes;
    into.insert(into.end(), broken.levels[l + 1].passes.begin(), broken.levels[l + 1].passes.end());
    broken.levels[l + 1].passes.clear();
    EXPECT_THAT(checkPlan(broken), Not(IsEmpty())) << l;
  }
}

TEST(Checker, PassesMissingOrTwice) {
  const Compiled c = richPlan();
  Plan broken = c.plan;
  broken.levels[2].passes.clear();
  EXPECT_THAT(checkPlan(broken), Contains(HasSubstr("runs 0 times")));
  broken = c.plan;
  broken.levels.back().passes.push_back(broken.levels[0].passes[0]);
  EXPECT_THAT(checkPlan(broken), Contains(HasSubstr("runs 2 times")));
}

TEST(Checker, WrongVersions) {
  // An update in place runs before a reader of the old value.
  Compiled c = compileText(R"({"passes": {
    "a": {"type": "source"}, "r": {"type": "storage-filter", "inputs": {"image": "a"}},
    "u": {"type": "update", "inputs": {"image": "a"}},
    "e": {"type": "blend", "inputs": {"a": "r", "b": "u"}}}, "outputs": {"o": "e"}})");
  ASSERT_EQ(c.order(), "a | r | u | e");
  // There is enough waiting everywhere, so that only the order is wrong.
  for (Level& level : c.plan.levels) {
    level.before.srcStage = level.before.dstStage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    level.before.srcAccess = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    level.before.dstAccess = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  }
  ASSERT_THAT(checkPlan(c.plan), IsEmpty());
  std::swap(c.plan.levels[1].passes, c.plan.levels[2].passes);
  EXPECT_THAT(checkPlan(c.plan), Contains(HasSubstr("should read version 1")));
}

TEST(Checker, LastFramesMemoryIsRemembered) {
  // Only the first barrier takes the previous frame into account.
  Compiled c =
      compileText(R"({"passes": {"a": {"type": "source"}, "b": {"type": "filter", "inputs": {"image": "a"}}},
    "outputs": {"o": "b"}})");
  c.plan.levels[0].before.images[0].srcStage = 0;
  EXPECT_THAT(checkPlan(c.plan), Not(IsEmpty()));
  EXPECT_THAT(checkPlan(c.plan, {1, {}}), IsEmpty());  // one frame alone is fine
}

// Removes the barriers of random plans one at a time: nearly all are needed. (Some memory barriers are
// covered by others.)
TEST(Checker, MutationsOfRandomPlans) {
  Registry registry;
  const std::vector<RandomType> types = addRandomTypes(registry, 7);
  uint32_t images = 0, imagesFound = 0, memories = 0, memoriesFound = 0;
  for (uint32_t seed = 0; seed < 60; ++seed) {
    Diagnostics messages;
    std::shared_ptr<const BoundGraph> graph;
    try {
      graph = bindText(randomGraph(types, 5000 + seed, 14), registry, messages);
    } catch (const Error&) {
      continue;
    }
    const Plan plan = compile(graph);
    for (size_t l = 0; l < plan.levels.size(); ++l) {
      for (size_t i = 0; i < plan.levels[l].before.images.size(); ++i) {
        Plan broken = plan;
        auto& list = broken.levels[l].before.images;
        list.erase(list.begin() + static_cast<ptrdiff_t>(i));
        ++images;
        imagesFound += !checkPlan(broken).empty();
      }
      if (plan.levels[l].before.srcStage == 0) continue;
      Plan broken = plan;
      BarrierBatch& batch = broken.levels[l].before;
      batch.srcStage = batch.dstStage = 0;
      batch.srcAccess = batch.dstAccess = 0;
      ++memories;
      memoriesFound += !checkPlan(broken).empty();
    }
  }
  EXPECT_GE(images, 100u);
  EXPECT_EQ(imagesFound, images);
  EXPECT_GE(memories, 50u);
  EXPECT_GE(memoriesFound * 10, memories * 9) << memoriesFound << " of " << memories;
}

}  // namespace
}  // namespace fovea::graph::test
