// The bound graph, as plain data: which pass accesses which resource, and how. bind() makes it from a description.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/graph.h"
#include "fovea/pass.h"

namespace fovea::graph {

inline constexpr uint32_t kNone = ~0u;

struct BoundResource {
  std::string name;  // "surface.surface.position": pass, port and member of its first version
  ResourceDesc desc;
  Lifetime lifetime = Lifetime::Transient;
  bool external = false;    // an input of the whole graph, in the caller's memory
  bool history = false;     // a pass reads last frame's value; two copies swap every frame
  bool output = false;      // an output of the graph, readable by transfer at the end of the frame
  bool observable = false;  // readable by transfer after any pass (Executor::observe)
  bool onHost = false;      // a step that runs on the host may reach it
  bool shared = false;      // such a step reaches it where it lies (shareWithHost())
  uint32_t usage = 0;       // union of the Usage bits of all passes
  uint32_t versions = 0;    // number of versions that its writers make
  uint32_t firstSlot = 0;   // Access::slot of version 0
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
  std::string name;  // "left/blur" inside a prefixed sub-graph
  const PassDeclaration* declaration = nullptr;
  Parameters parameters;
  uint32_t view = 0;                 // index into BoundGraph::views
  std::span<const Access> accesses;  // declaration order; a part of BoundGraph::accesses
  bool spared = false;               // its output, or what follows from it, is left unused by a parameter
};

// The access through which the pass reaches a port or a member ("surface.position"). Throws Error(Internal) with the
// nearest name if the pass has none that is wired.
uint32_t accessOf(const BoundPass& pass, std::string_view path);
// All names that accessOf() knows.
std::vector<std::string> wiredPaths(const BoundPass& pass);

struct BoundOutput {
  std::string name;
  uint32_t resource = kNone;
  uint32_t version = 0;  // must be the resource's last version
};

struct BoundGraph {
  std::string name, description;
  std::vector<std::string> views;  // views used by a pass; [0] is "main" by default
  Parameters view;                 // the values of viewParameters()
  std::vector<BoundPass> passes;   // declaration order
  // Storage of the parameters and accesses of `passes`, whose copies share it.
  std::shared_ptr<const std::vector<Value>> values;
  std::shared_ptr<const std::vector<Access>> accesses;
  std::vector<BoundResource> resources;
  std::vector<BoundOutput> outputs;  // bundles are expanded: "surface.position"
  // Whether steps that trace rays run on the host, as far as their kernels are compiled for it (host_kernel.h).
  bool raysOnHost = false;
  uint32_t slots = 0;  // number of values of Access::slot
  uint64_t hash = 0;   // hash of everything the graph was derived from
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
