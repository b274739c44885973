// A pass: a declaration (data), kernels made once, and commands recorded every frame.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/gpu/shader.h"
#include "framework/graph/declaration.h"

namespace fovea::gpu {
class Device;
class Buffer;
class Image;
class Pipeline;
}  // namespace fovea::gpu

namespace fovea::scene {
struct Frame;  // views, gaze, lights, time, scene: framework/scene/frame.h
struct View;
}  // namespace fovea::scene

namespace fovea::graph {

struct PassInstance;   // execute.cpp
struct KernelState;    // execute.cpp

// A pipeline with its bindings resolved by name against the pass's ports. Cheap to copy.
class Kernel {
 public:
  explicit operator bool() const { return state_ != nullptr; }

 private:
  friend class PrepareContext;
  friend class RecordContext;
  friend class Commands;
  KernelState* state_ = nullptr;
};

struct GraphicsKernelDesc {
  std::string vertex, fragment;         // shader files; fragment may be empty
  gpu::Defines defines;
  std::vector<std::string> colors;      // ports or members, in the order of the fragment outputs
  std::string depth;                    // port or member, "" for none
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
  bool depthWrite = true;
  bool additiveBlend = false;
  float depthBiasConstant = 0, depthBiasSlope = 0;
};

// Once per plan: make kernels here, so that the frame loop compiles nothing.
class PrepareContext {
 public:
  explicit PrepareContext(PassInstance& pass) : pass_(pass) {}
  gpu::Device& device() const;
  const Parameters& parameters() const;
  bool has(std::string_view port) const;  // an optional input is wired
  // An output, or a member of one, is read by another pass, in this frame or the next, or is an output of the graph.
  // Nothing need be written to one that is not.
  bool isRead(std::string_view path) const;
  VkExtent3D extent(std::string_view port) const;
  uint32_t layers(std::string_view port) const;
  uint64_t count(std::string_view port) const;  // elements of a buffer
  // Every binding of set 0 must be a port ("radiance"), a member ("gbuffer.position" as gbufferPosition), `counters`,
  // or be bound by hand in record(). Throws Error(BadInput) naming shader, binding and the nearest port.
  Kernel compute(const std::string& shader, gpu::Defines defines = {});
  Kernel graphics(const GraphicsKernelDesc& desc);
  // A fragment shader that writes every pixel of images of one size (ports or members, Usage::ColorAttachment, in the
  // order of its outputs). On a CPU device a store to an image costs several times as much as such an output.
  Kernel fullscreen(const std::string& fragment, const std::vector<std::string>& colors, gpu::Defines defines = {});

 private:
  PassInstance& pass_;
};

class RecordContext;

// One dispatch or draw being put together: ctx.use(kernel).constant("count", n).dispatchThreads(n);
// Push constants that carry the name of a parameter (camelCase), `frameIndex` or `seed` fill themselves.
// A constant or binding that stays unset throws Error(Internal) naming it.
class Commands {
 public:
  template <class T>
  Commands& constant(std::string_view name, const T& value) {
    return constantBytes(name, &value, sizeof(T));
  }
  Commands& bind(std::string_view name, VkImageView view);  // e.g. one mip level; layout as the port's
  Commands& bind(std::string_view name, const gpu::Buffer& buffer, uint64_t offset, uint64_t range);
  // A page of a buffer port: for uniform buffers past the device's range.
  Commands& range(std::string_view port, uint64_t offset, uint64_t bytes);
  void dispatch(uint32_t groupsX, uint32_t groupsY = 1, uint32_t groupsZ = 1);
  void dispatchThreads(uint32_t x, uint32_t y = 1, uint32_t z = 1);  // rounded up to whole groups
  void dispatchOver(std::string_view imagePort);                     // one thread a texel (and layer or slice)
  void dispatchIndirect(std::string_view bufferPort, uint64_t offset = 0);
  void drawFullscreen();                                             // of PrepareContext::fullscreen
  void draw(uint32_t vertices, uint32_t instances = 1, uint32_t firstInstance = 0);
  void drawIndexed(VkBuffer indices32, uint32_t count, uint32_t first = 0, uint32_t instances = 1,
                   uint32_t firstInstance = 0);
  void drawIndirect(std::string_view bufferPort, uint64_t offset, uint32_t count, uint32_t stride);

 private:
  friend class RecordContext;
  Commands(RecordContext& context, KernelState& kernel);
  Commands& constantBytes(std::string_view name, const void* data, size_t bytes);
  void checkConstants() const;
  void flush();
  RecordContext& context_;
  KernelState& kernel_;
  std::byte constants_[128]{};
  uint64_t constantsSet_ = 0;  // bit per member
};

struct Attachment {
  std::string port;
  enum class Load { Clear, Keep, Discard } load = Load::Clear;
  VkClearValue clear{};
};

// Once per frame. All look-ups are by the names of the declaration.
class RecordContext {
 public:
  RecordContext(PassInstance& pass, VkCommandBuffer cmd, const scene::Frame& frame, uint64_t frameNumber);
  VkCommandBuffer cmd() const { return cmd_; }
  gpu::Device& device() const;
  const Parameters& parameters() const;
  const scene::Frame& frame() const { return frame_; }
  const scene::View& view() const;       // the view the graph file gave this pass
  uint64_t frameNumber() const { return frameNumber_; }
  bool has(std::string_view port) const;
  bool firstFrame() const;                          // kept and history resources were just zeroed
  gpu::Image& image(std::string_view port) const;   // "radiance" or "gbuffer.position"
  gpu::Buffer& buffer(std::string_view port) const;
  VkExtent3D extent(std::string_view port) const;
  uint64_t count(std::string_view port) const;      // elements of a buffer

  Commands use(Kernel kernel);
  // Dynamic rendering over whole images (all layers when `layers` > 1).
  void render(const std::vector<Attachment>& colors, const Attachment* depth, const std::function<void()>& body,
              uint32_t layers = 1);
  void render(const std::vector<Attachment>& colors, const Attachment* depth, VkRect2D area,
              const std::function<void()>& body, uint32_t layers = 1);
  void fill(std::string_view bufferPort, uint32_t word);               // TransferWrite; whole buffer
  void clear(std::string_view imagePort, VkClearColorValue value);     // TransferWrite or StorageWrite; whole image
  // TransferRead to TransferWrite; whole colour images of one size and format, without mips.
  void copy(std::string_view imageFrom, std::string_view imageTo);
  // Between commands of this pass that depend on each other: everything before is visible to everything after.
  void barrier();
  // A counter the CPU knows. Counters written on the GPU: `uint counters[]` in set 0, in declared order.
  void counter(std::string_view name, double value);

 private:
  friend class Commands;
  PassInstance& pass_;
  VkCommandBuffer cmd_;
  const scene::Frame& frame_;
  uint64_t frameNumber_;
};

// Host passes: inputs and outputs as plain memory (images tightly packed, layer after layer).
class HostContext {
 public:
  HostContext(PassInstance& pass, const scene::Frame& frame, uint64_t frameNumber);
  const Parameters& parameters() const;
  const scene::Frame& frame() const { return frame_; }
  const scene::View& view() const;
  uint64_t frameNumber() const { return frameNumber_; }
  bool has(std::string_view port) const;
  bool firstFrame() const;
  VkExtent3D extent(std::string_view port) const;
  uint64_t count(std::string_view port) const;
  std::span<const std::byte> input(std::string_view port) const;
  std::span<std::byte> output(std::string_view port) const;  // whole resource; every byte must be written
  template <class T>
  std::span<const T> inputAs(std::string_view port) const {
    auto bytes = input(port);
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  template <class T>
  std::span<T> outputAs(std::string_view port) const {
    auto bytes = output(port);
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  void counter(std::string_view name, double value);
  // For passes that take long, now and then and on the thread of execute(): the share that is done, 0 to 1. False: nobody
  // wants to wait any longer; end soon, with outputs as good as they are by then.
  bool progress(double share) const;

 private:
  PassInstance& pass_;
  const scene::Frame& frame_;
  uint64_t frameNumber_;
};

class Pass {
 public:
  virtual ~Pass() = default;
  virtual void prepare(PrepareContext&) {}
  virtual void record(RecordContext&) {}   // Compute and Graphics
  virtual void execute(HostContext&) {}    // Host
};

}  // namespace fovea::graph
