// Internal to the checker: past accesses, and what barriers have done to them since.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace fovea::graph::checker {

// Single stages, so that testing whether all stages are covered is a plain mask test.
inline constexpr VkPipelineStageFlags2 kStages[] = {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                                                    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT,
                                                    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                                    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT,
                                                    VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                                                    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                                    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                                    VK_PIPELINE_STAGE_2_COPY_BIT,
                                                    VK_PIPELINE_STAGE_2_RESOLVE_BIT,
                                                    VK_PIPELINE_STAGE_2_BLIT_BIT,
                                                    VK_PIPELINE_STAGE_2_CLEAR_BIT,
                                                    VK_PIPELINE_STAGE_2_HOST_BIT};
inline constexpr int kStageCount = static_cast<int>(std::size(kStages));

// Bit i stands for kStages[i].
using StageSet = uint32_t;
StageSet stageSet(VkPipelineStageFlags2 stages);

// An access in one stage that later accesses may have to wait for.
struct Event {
  StageSet stage = 0;  // a single bit; 0 for a layout change
  VkAccessFlags2 access = 0;
  bool write = false;
  bool available = false;                          // writes: flushed by a barrier
  StageSet after = 0;                              // stages that are ordered after it
  std::array<VkAccessFlags2, kStageCount> seen{};  // writes: accesses that see it, per stage
};

struct Scope {
  StageSet src = 0, dst = 0;
  VkAccessFlags2 srcAccess = 0, dstAccess = 0;
};

// Whether the event is in the first scope of the barrier, directly or through an earlier barrier.
bool inFirstScope(const Event& event, const Scope& scope);
// Whether the event's write is available after this barrier.
bool flushed(const Event& event, const Scope& scope);
void applyBarrier(Event& event, const Scope& scope);

// Stages and accesses of one kind of use.
struct Need {
  StageSet stages = 0;
  VkAccessFlags2 access = 0;
  bool write = false;
  bool contents = false;  // reads what was there before the pass, not only what it has written itself
};

// ordered() tells whether all stages of `need` wait for the event, visible() whether all of them see its write.
bool ordered(const Event& event, const Need& need);
bool visible(const Event& event, const Need& need);
std::vector<Event> eventsOf(const Need& need);

}  // namespace fovea::graph::checker
