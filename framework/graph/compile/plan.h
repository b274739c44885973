// The plan, as plain data: what the device does in every frame. compile() makes it from a bound graph.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "framework/graph/compile/bound.h"
#include "framework/graph/run/host_kernel.h"

namespace fovea::graph {

struct ImageBarrier {
  uint32_t resource = kNone;
  bool previous = false;
  VkPipelineStageFlags2 srcStage = 0, dstStage = 0;
  VkAccessFlags2 srcAccess = 0, dstAccess = 0;
  VkImageLayout oldLayout = VK_IMAGE_LAYOUT_UNDEFINED, newLayout = VK_IMAGE_LAYOUT_UNDEFINED;
};

// A dependency between commands, as one global memory barrier expresses it. Empty if nothing has to be waited for.
struct Dependency {
  VkPipelineStageFlags2 srcStage = 0, dstStage = 0;
  VkAccessFlags2 srcAccess = 0, dstAccess = 0;
  explicit operator bool() const { return srcStage != 0; }
  Dependency& operator|=(const Dependency& other);
};

// One vkCmdPipelineBarrier2: memory hazards are merged into one global barrier, images occur only for layout changes.
struct BarrierBatch : Dependency {
  std::vector<ImageBarrier> images;
  bool empty() const { return srcStage == 0 && dstStage == 0 && images.empty(); }
};

struct Level {
  BarrierBatch before;
  std::vector<uint32_t> passes;  // indices into BoundGraph::passes, without hazards among them
};

// What one step of a pass does to one of its resources.
struct StepAccess {
  uint32_t access = kNone;  // BoundPass::accesses
  VkPipelineStageFlags2 stage = 0;
  VkAccessFlags2 mask = 0;
  bool reads = false, writes = false;
};

// A step that takes part in a plan, and what it waits for.
struct PlannedStep {
  uint32_t step = kNone;  // PassDeclaration::steps
  Dependency before;
  std::vector<StepAccess> accesses;
  bool tracesRays = false;
  HostKernel host = nullptr;  // runs it, if it is not the device
};

// The place of a transient resource in its heap.
struct Placement {
  uint32_t resource = kNone;
  uint32_t heap = 0;  // one heap per distinct set of memory types
  uint64_t offset = 0, bytes = 0;
};

struct Plan {
  std::shared_ptr<const BoundGraph> graph;
  std::vector<Level> levels;
  BarrierBatch end;  // makes the outputs readable by transfer
  // For each pass, its declared steps in order; empty where the plan was made without shaders.
  std::vector<std::vector<PlannedStep>> steps;
  std::vector<Placement> placements;  // live transient resources
  struct Heap {
    uint64_t bytes = 0;
    uint32_t memoryTypeBits = ~0u;
  };
  std::vector<Heap> heaps;
  std::vector<uint8_t> passLive, resourceLive;  // 1 or 0
  // Layout of each live image at the end of a frame and hence at the start of the next: [0] of the current copy, [1] of
  // the previous copy as it is at the start of the frame. Kept and history images are put into it when they are zeroed.
  std::vector<std::array<VkImageLayout, 2>> startLayout;
  std::vector<VkImageLayout> endLayout;           // of the current copy
  uint64_t bytesAliased = 0, bytesUnaliased = 0;  // transient memory with and without aliasing
  uint64_t bytesKept = 0;                         // kept and history resources
  uint64_t hash = 0;
};

}  // namespace fovea::graph
