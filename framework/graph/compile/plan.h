// The results of the compiler phases, as plain data. Each phase is a pure function of the previous result:
//   document -> Description (resolve) -> BoundGraph (bind) -> Schedule -> lifetimes, alias, barriers -> Plan
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/graph.h"
#include "fovea/pass.h"
#include "framework/base/small_vector.h"

namespace fovea::graph {

inline constexpr uint32_t kNone = ~0u;

// Some constructors below do nothing but are not defaulted, because a defaulted one fills every byte with zeros
// before the members are set, and lists grow by thousands of these elements.

struct BoundResource {
  BoundResource(Lifetime lives, uint32_t made) : lifetime(lives), versions(made) {}
  std::string name;  // "surface.surface.position": pass, port and member of its first version
  ResourceDesc desc;
  Lifetime lifetime = Lifetime::Transient;
  bool external = false;   // an input of the whole graph, in the caller's memory
  bool history = false;    // a pass reads last frame's value; two copies swap every frame
  bool output = false;     // an output of the graph, readable by transfer at the end of the frame
  uint32_t usage = 0;      // union of the Usage bits of all passes
  uint32_t versions = 0;   // number of versions that its writers make
  uint32_t firstSlot = 0;  // Access::slot of version 0
};

// One access of a pass to a resource.
struct Access {
  uint32_t resource = kNone;
  uint16_t port = 0, member = 0;  // in the declaration
  Usage usage = Usage::None;
  bool reads = false, writes = false;
  bool previous = false;  // last frame's copy
  uint32_t version = 0;   // writes: the version made; reads: the version seen (0 before any write)
  uint32_t slot = 0;      // index among the versions of all resources; last frame's copy follows the last one
  // For images: the layout while the pass runs, which its descriptors and attachments must name. All accesses of a
  // pass to the image share one layout, as do all readers of one version (GENERAL if they want different ones).
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

struct BoundPass {
  explicit BoundPass(std::string_view called) : name(called) {}
  std::string name;  // "left/blur" inside a prefixed sub-graph
  const PassDeclaration* declaration = nullptr;
  Parameters parameters;
  uint32_t view = 0;                // index into BoundGraph::views
  SmallVector<Access, 4> accesses;  // declaration order
};

// The access through which the pass reaches a port or a member ("surface.position"). Throws Error(Internal) with the
// nearest name if the pass has none that is wired.
uint32_t accessOf(const BoundPass& pass, std::string_view path);

struct BoundOutput {
  std::string name;
  uint32_t resource = kNone;
  uint32_t version = 0;  // must be the resource's last version
};

struct BoundGraph {
  std::string name, description;
  std::vector<std::string> views;                    // views used by a pass; [0] is "main" by default
  std::vector<BoundPass> passes;                     // declaration order
  std::shared_ptr<const std::vector<Value>> values;  // storage of the parameters of `passes`
  std::vector<BoundResource> resources;
  std::vector<BoundOutput> outputs;  // bundles are expanded: "surface.position"
  uint32_t slots = 0;                // number of values of Access::slot
  uint64_t hash = 0;                 // hash of everything the graph was derived from
};

struct ImageBarrier {
  uint32_t resource = kNone;
  bool previous = false;
  VkPipelineStageFlags2 srcStage = 0, dstStage = 0;
  VkAccessFlags2 srcAccess = 0, dstAccess = 0;
  VkImageLayout oldLayout = VK_IMAGE_LAYOUT_UNDEFINED, newLayout = VK_IMAGE_LAYOUT_UNDEFINED;
};

// One vkCmdPipelineBarrier2: memory hazards are merged into one global barrier, images occur only for layout changes.
struct BarrierBatch {
  VkPipelineStageFlags2 srcStage = 0, dstStage = 0;
  VkAccessFlags2 srcAccess = 0, dstAccess = 0;
  SmallVector<ImageBarrier, 4> images;  // inline room for what a pass alone in its level reads and writes
  bool empty() const { return srcStage == 0 && dstStage == 0 && images.empty(); }
};

struct Level {
  Level() {}
  BarrierBatch before;
  SmallVector<uint32_t, 2> passes;  // indices into BoundGraph::passes, without hazards among them
};

// A dependency between commands, as one global memory barrier expresses it. Empty if nothing has to be waited for.
struct Dependency {
  VkPipelineStageFlags2 srcStage = 0, dstStage = 0;
  VkAccessFlags2 srcAccess = 0, dstAccess = 0;
  explicit operator bool() const { return srcStage != 0; }
  Dependency& operator|=(const Dependency& other);
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

// Layout and synchronization scope of a single access by itself; the layout in force is Access::layout. Host passes
// reach their resources through copies: HostRead is a transfer read (TRANSFER_SRC), HostWrite a transfer write.
struct AccessScope {
  VkPipelineStageFlags2 stage = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};
AccessScope accessScope(PassKind kind, Usage usage, bool reads, bool writes);
VkImageLayout accessLayout(Usage usage, bool reads, bool writes);  // only the layout

}  // namespace fovea::graph
