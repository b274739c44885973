// Internal to the executor: the state of passes, kernels and resources while a plan runs.
#pragma once

#include <any>
#include <array>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "fovea/pass.h"
#include "framework/gpu/device.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/timestamps.h"
#include "framework/graph/compile/plan.h"
#include "framework/graph/pass/guard.h"
#include "framework/graph/run/execute.h"
#include "framework/graph/run/host_steps.h"
#include "framework/graph/steps/steps.h"

namespace fovea::graph {

// The memory behind one BoundResource. A history resource has two copies that swap every frame; others use only [0].
struct PhysicalResource {
  std::array<gpu::Image, 2> images;
  std::array<gpu::Buffer, 2> buffers;
};

// Mapped memory through which a host pass reads or writes one of its resources; one buffer per frame in flight.
struct HostStaging {
  std::vector<gpu::Buffer> slots;
};

struct StringHash {
  using is_transparent = void;
  size_t operator()(std::string_view s) const { return std::hash<std::string_view>{}(s); }
};
template <class T>
using NameMap = std::unordered_map<std::string, T, StringHash, std::equal_to<>>;

// State that all passes of an executor share.
struct ExecutorState {
  gpu::Device* device = nullptr;
  const Plan* plan = nullptr;
  VkDescriptorSetLayout sharedLayout = VK_NULL_HANDLE;
  std::vector<PhysicalResource> resources;
  // Of the executor that this one takes over from, while this one is made.
  std::map<std::string, std::shared_ptr<gpu::Pipeline>, std::less<>> pipelines;
  // By resource: where it was taken over with its contents, the layouts in which its two copies are found.
  std::vector<std::optional<std::array<VkImageLayout, 2>>> adopted;
  gpu::Buffer counters;     // uint32 counters of all passes, zeroed every frame
  gpu::Buffer dummyBuffer;  // stands in for optional inputs that are not wired
  std::vector<VkDeviceMemory> heaps;
  HostProgress hostProgress;
  // Submits the commands recorded so far, waits for them, and begins new ones.
  std::function<VkCommandBuffer()> finishAndBegin;
  std::optional<gpu::TimestampRing> timestamps;
  bool countOperations = false;  // ExecutorOptions::countOperations

  // State of the current frame.
  VkDescriptorSet sharedSet = VK_NULL_HANDLE;
  uint32_t slot = 0;
  uint32_t parity = 0;
  bool started = false;         // whether a frame has been submitted
  bool cameraCut = false;       // in this frame
  uint32_t stepTimestamps = 0;  // left for boundaries between steps
  const scene::HostScene* hostScene = nullptr;

  uint32_t copyIndex(const Access& access) const {
    if (!plan->graph->resources[access.resource].history) return 0;
    return access.previous ? 1 - parity : parity;
  }
  gpu::Image& image(const Access& a) { return resources[a.resource].images[copyIndex(a)]; }
  gpu::Buffer& buffer(const Access& a) { return resources[a.resource].buffers[copyIndex(a)]; }
};

struct KernelBinding {
  enum class Source { Port, Counters, Operations, Sampler, Manual } source = Source::Manual;
  gpu::ReflectedBinding reflected;
  uint32_t access = kNone;  // index into BoundPass::accesses
  VkSampler sampler = VK_NULL_HANDLE;
  std::string port;  // for messages
};

// A row of the timings: a step, or commands that a pass records by itself.
using Label = uint32_t;  // PassInstance::labels

struct KernelConstant {
  gpu::ReflectedMember reflected;
  enum class Source { Manual, Parameter, FrameIndex, Seed, FoveaRadius } source = Source::Manual;
  uint32_t parameter = kNone;
};

struct KernelState {
  PassInstance* pass = nullptr;
  std::string name;
  Label label = 0;
  std::shared_ptr<gpu::Pipeline> pipeline;  // shared with an executor that takes over from this one
  std::string key;                          // of the pipeline, in ExecutorState::pipelines
  HostKernel host = nullptr;                // runs it, if it is not the device
  std::vector<StepAccess> accesses;         // through its bindings, except those made by hand
  std::vector<KernelBinding> bindings;
  std::vector<KernelConstant> constants;
  // Set by Commands::mip and Commands::range for the command under construction.
  struct Override {
    uint32_t binding = kNone;
    uint32_t access = kNone;
    VkImageView view = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
    uint64_t offset = 0, range = VK_WHOLE_SIZE;
  };
  std::vector<Override> overrides;
  std::vector<Attachment> covers;  // attachments that a full-screen kernel writes
  uint32_t vertices = 3;           // with which it does so
  VkExtent2D tiled{};              // pixels that its tiles span, if it draws tiles
};

// A declared step that takes part in the plan, with everything that no frame changes.
struct StepInstance {
  const PlannedStep* planned = nullptr;
  const StepSpec* spec = nullptr;
  KernelState* kernel = nullptr;  // null for transfers
  std::array<uint32_t, 3> size{};
  std::vector<std::pair<std::string, uint32_t>> constants;
};

enum class Transfer : uint8_t { Fill, Clear, Copy };

// Where the time of a step begins; it ends where that of the next one begins, or with the pass.
struct StepBegin {
  Label label = 0;
  uint32_t timestamp = 0;  // index into the frame's timestamps
};

struct PassInstance {
  ExecutorState* state = nullptr;
  const BoundPass* bound = nullptr;
  uint32_t index = 0;  // in BoundGraph::passes
  std::unique_ptr<Pass> pass;
  std::string plugin;  // file that the pass comes from; empty if it is linked in
  NameMap<uint32_t> counterByName;
  std::deque<KernelState> kernels;  // stable addresses
  std::vector<StepInstance> steps;  // those of the plan
  NameMap<uint32_t> stepByName;     // kNone for declared steps that are not in the plan
  std::vector<std::string> labels;
  std::vector<std::array<Label, 3>>
      transferLabels;  // per access and kind of transfer; kNone before the first
  StepTracker tracker;
  std::vector<StepBegin> begun;           // this frame
  std::vector<StepAccess> touched;        // by the command under construction
  std::span<const Kernel> renderKernels;  // with which the current rendering may draw
  bool rendering = false;
  CommandCounts commands;             // of this frame
  uint32_t layer = kNone;             // that is rendered, where the layers of a rendering take turns
  std::vector<double> counterValues;  // set by the CPU
  std::vector<bool> counterSet;
  uint64_t counterOffset = 0;        // bytes into ExecutorState::counters
  uint64_t operationsOffset = 0;     // the same, of the number of its operations
  std::vector<HostStaging> staging;  // host passes: one per access
  HostSteps host;                    // steps that run there, of other passes
  bool fresh = true;                 // not all that it keeps was taken over
  std::any memory;                   // RecordContext::memory
  uint32_t viewIndex = 0;            // index into Frame::views, this frame
  uint32_t viewOffset = 0;           // of that view in the shared set's dynamic uniform buffer

  PassInstance(ExecutorState& executorState, uint32_t passIndex, std::unique_ptr<Pass> implementation);
  const Access& access(std::string_view path) const;  // throws Error(Internal) with the nearest port
  const ResourceDesc& desc(const Access& a) const { return state->plan->graph->resources[a.resource].desc; }
  Label label(std::string_view name);
  // Begins the time of a step, unless it is that of the command before.
  void beginRow(VkCommandBuffer cmd, Label of);
  // The same, and waits for what the accesses depend on.
  void beginCommand(VkCommandBuffer cmd, Label of, std::span<const StepAccess> accesses,
                    bool together = false);
  // Whether kept and history resources that it uses were zeroed in this frame.
  bool firstFrame() const { return state->cameraCut || (!state->started && fresh); }
  PassOrigin origin() const { return {bound->name, bound->declaration->type, plugin}; }
};

// Writes a timestamp between the commands before and after. Returns its index in the frame.
uint32_t writeTimestamp(ExecutorState& state, VkCommandBuffer cmd);

// Defined in kernels.cpp.
bool isImageBinding(gpu::BindingKind kind);
PassKind stagesOf(const KernelState& kernel);
[[noreturn]] void bindingError(const PassInstance& pass, const std::string& shader,
                               const std::string& message, const std::string& remedy);
// Kernels and sizes of the declared steps.
void buildSteps(PassInstance& pass, const std::vector<PlannedStep>& planned);

// Defined in memory.cpp: everything that a plan needs on the device.
gpu::BufferDesc bufferDesc(const BoundResource& resource);
gpu::ImageDesc imageDesc(const BoundResource& resource);
void allocateResources(ExecutorState& state);
void freeResources(ExecutorState& state);
uint64_t resourceBytes(const ResourceDesc& desc);  // tightly packed: mip after mip, each with all layers
// At the first frame, zeroes kept and history resources except those that were taken over; on a camera cut, all but
// those of the scene's lifetime. Leaves images in the layout that the plan expects at the start of a frame.
void resetKeptResources(ExecutorState& state, VkCommandBuffer cmd);
VkImageSubresourceRange wholeImage(const gpu::Image& image);
// Between any commands, for all of an image.
VkImageMemoryBarrier2 layoutChange(const gpu::Image& image, VkImageLayout from, VkImageLayout to);
// Regions that copy between an image (all mips and layers) and a tightly packed buffer.
std::vector<VkBufferImageCopy> packedCopy(const gpu::Image& image);

}  // namespace fovea::graph
