// Replays a plan on a device, frame after frame. The frame loop allocates nothing, compiles nothing and
// does not wait for results.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/graph.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/compile/plan.h"

namespace fovea::gpu {
class Device;
class ShaderCompiler;
}  // namespace fovea::gpu
namespace fovea::scene {
struct Frame;
class FrameDescriptors;
}  // namespace fovea::scene

namespace fovea::graph {

class Registry;

// Called by a host pass that runs long, with its name and the completed share of its work (0 to 1). Returning false
// asks the pass to finish soon with the results it has.
using HostProgress = std::function<bool(const std::string& pass, double share)>;

struct ExecutorOptions {
  uint32_t framesInFlight = 2;
  std::vector<std::string> readback;  // graph outputs that a frame may ask to have read back
  HostProgress hostProgress;          // called inside submit()
  // Whether shaders count their floating-point operations (gpu::countingShader), which makes frames slower. Steps that
  // run on the host do not.
  bool countOperations = false;
  // Whether contents are taken over from the executor before, if there is one. If not, only pipelines are, and the next
  // frame is the first one.
  bool keepContents = true;
};

// A resource as one pass leaves it, to be read back right after that pass, before anything overwrites it. Of an image
// with several mips or layers (or slices of a volume), one is read; of a buffer, what fits into `mostBytes`.
struct Observation {
  std::string name;     // of the result among FrameResult::outputs
  uint32_t pass = 0;    // index into BoundGraph::passes
  uint32_t access = 0;  // index into BoundPass::accesses
  uint32_t mip = 0, layer = 0;
  uint64_t mostBytes = ~uint64_t(0);
  bool operator==(const Observation&) const = default;
};

// An image that is not the executor's, such as one of a display, into which a frame copies an output on the device.
struct OutputCopy {
  std::string output;  // of the graph, an image
  VkImage image = VK_NULL_HANDLE;
  // At least as large as the output, with texels of the same size, which are copied to its top left corner as they are.
  uint32_t layer = 0;
  // In which the frame finds the image and leaves it. What was in it before is lost.
  VkImageLayout layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
};

// The fields of the elements of buffers, by the name of their type (ResourceSpec::element).
using ElementTypes = std::map<std::string, std::vector<RecordField>>;

// The device memory that a bound resource needs; input to the aliasing phase.
MemoryNeed deviceMemory(gpu::Device& device, const BoundResource& resource);

// Adds the folders in which the shaders of the project's passes and of plug-ins lie.
void addShaderFolders(gpu::ShaderCompiler& compiler, const Registry& registry);

// Options of compile() for a device, with resource sizes as its driver reports them.
CompileOptions deviceCompileOptions(gpu::Device& device, std::shared_ptr<const BoundGraph> graph);

// Replaces formats of images that a device cannot have by wider ones (VK_FORMAT_R16G16_SNORM of
// gpu::dispensableFeatures()).
void replaceFormats(const gpu::Device& device, BoundGraph& graph);
// Where the host shares the memory of the device, lets steps on the host reach resources without copies.
void shareWithHost(const gpu::Device& device, BoundGraph& graph);

// The limits of a device against which a graph is checked; unknown if `device` is nullptr. Views and quantities are
// left to the caller.
Environment deviceEnvironment(const gpu::Device* device);

class Executor {
 public:
  // Allocates all memory and prepares all passes, which compiles their shaders. Throws Error(OutOfMemory) naming the
  // resource and its size, and Error(BadInput) for shaders that do not compile or bind.
  //
  // It takes over from the executor `before`, if there is one: pipelines that both need, and kept and history resources
  // with their contents. These must have the same name, size and lifetime in both plans, and the passes that write
  // them the same name, type and shaders, and the same parameters for what is kept for the scene. What passes remember
  // (RecordContext::memory) is taken over where nothing that leads to it has changed. A host pass of which nothing has
  // changed keeps what it remembers. `before`
  // must belong to the same device and scene, and its frames must have been returned. It is of no use afterwards,
  // unless this constructor throws.
  Executor(gpu::Device& device, std::shared_ptr<const Plan> plan, const Registry& registry,
           scene::FrameDescriptors& scene, const ExecutorOptions& options = {}, Executor* before = nullptr);
  ~Executor();

  // Sets the contents of an input of the whole graph ("radiance", "surface.position"), which stay until they are set
  // again. `bytes` are its texels or elements, tightly packed, or for light ("light": true) 32-bit floats in the units
  // of the scene; `preExposure` is Frame::preExposure of that scene. Waits for the device. Throws Error(BadInput) for an input that
  // the graph does not have, or another number of bytes.
  void setInput(const std::string& name, std::span<const std::byte> bytes, float preExposure = 1);

  // Chooses what frames that are submitted with `observe` read back besides the outputs. Finishes the frames under way
  // and allocates, so that frames do neither. Throws Error(BadInput) for a pass that does not run and for an image
  // that was not bound as observable.
  void observe(std::vector<Observation> observations);

  // As the shaders of this plan declare them: a buffer in a shader is bound to the port of the same name, and its array
  // says what an element of the port consists of. Types that shaders know only as texels are not among them.
  ElementTypes elementTypes() const;

  // Records and submits one frame. Blocks only while framesInFlight frames are unfinished, or for a host pass that
  // reads what this frame's GPU passes wrote. Throws Error(BadInput) for a copy of an output that the graph does not have.
  void submit(const scene::Frame& frame, bool readOutputs = false, bool observe = false,
              std::span<const OutputCopy> copies = {});

  // The oldest finished frame that was not returned yet; nullopt if there is none. Never blocks.
  std::optional<FrameResult> poll();
  // Waits for the oldest frame that was not returned yet; nullopt if every submitted frame was returned.
  std::optional<FrameResult> next();

  // Whether a pass runs on the CPU and therefore reads Frame::geometry. The vertices that GPU passes see depend only
  // on Frame::objects, joints and weights.
  bool readsGeometry() const;

  uint64_t residentBytes() const;  // device memory held by this executor

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::graph
