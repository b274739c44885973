// A pass consists of a declaration (plain data, fovea/declaration.h) and, where a list of steps is not enough, of
// kernels that are built once per plan and commands that are recorded every frame.
//
// Functions whose signatures name types of namespace gpu are meant for the project's own passes; plug-ins do not need
// them.
#pragma once

#include <vulkan/vulkan.h>

#include <any>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fovea/declaration.h"
#include "fovea/registration.h"

namespace fovea::gpu {
class Device;
class Buffer;
class Image;
}  // namespace fovea::gpu

namespace fovea::scene {
struct Frame;  // defined in fovea/scene.h
struct View;
}  // namespace fovea::scene

namespace fovea::graph {

struct BoundGraph;
struct BoundPass;
struct ResourceDesc;  // defined in fovea/graph.h
struct PlannedStep;

// ---- Kernels and contexts --------------------------------------------------------------------------------------

// Preprocessor macros with which a shader is compiled.
using Defines = std::map<std::string, std::string>;

struct PassInstance;  // private to the executor
struct KernelState;

// A pipeline whose bindings are resolved by name against the ports of the pass. Cheap to copy.
class Kernel {
 public:
  explicit operator bool() const { return state_ != nullptr; }
  // Names the row of the timings to which its commands count; by default that is the name of its shader. Kernels that
  // alternate in a loop should share a row, because each change of row costs a timestamp.
  Kernel& called(const std::string& row);

 private:
  friend class PrepareContext;
  friend class RecordContext;
  friend class Commands;
  friend void buildSteps(PassInstance& pass, const std::vector<PlannedStep>& planned);
  KernelState* state_ = nullptr;
};

struct GraphicsKernelDesc {
  std::string vertex, fragment;  // shader files; fragment may be empty
  Defines defines;
  std::vector<std::string> colors;  // ports or members, in the order of the fragment outputs
  std::string depth;                // port or member; "" for none
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
  bool depthWrite = true;
  bool additiveBlend = false;
  float depthBiasConstant = 0, depthBiasSlope = 0;
};

// What a bound pass knows about its place in the graph. All look-ups use the names of the declaration.
class PassContext {
 public:
  PassContext(const BoundGraph& graph, const BoundPass& pass) : graph_(graph), bound_(pass) {}
  const Parameters& parameters() const;
  bool has(std::string_view port) const;  // whether an optional input is wired
  // Whether an output, or a member of one, is read by another pass or in the next frame, or is an output of the
  // graph. If it is not, the pass need not write it.
  bool isRead(std::string_view path) const;
  VkExtent3D extent(std::string_view port) const;
  uint32_t layers(std::string_view port) const;
  uint32_t mips(std::string_view port) const;
  uint64_t count(std::string_view port) const;  // number of elements in a buffer
  const ResourceDesc& desc(std::string_view port) const;
  // Conditions are 0 or 1; the sizes of an input that is not wired are 0.
  // Throws Error(BadInput) on overflow and division by zero.
  int64_t evaluate(const SizeExpr& expression) const;

 private:
  const BoundGraph& graph_;
  const BoundPass& bound_;
};

// Passed to Pass::prepare() once per plan. All kernels are built here, so that the frame loop compiles nothing; those
// of declared steps are built by the framework.
class PrepareContext : public PassContext {
 public:
  explicit PrepareContext(PassInstance& pass);
  gpu::Device& device() const;
  // Every binding of set 0 must be a port ("radiance"), a member ("surface.position", bound as surfacePosition), a
  // sampler (linearClamp, linearRepeat, nearestClamp or nearestRepeat) or `counters`, or be bound by hand in
  // record(). Throws Error(BadInput) naming the shader, the binding and, where one is similar, the nearest port.
  Kernel compute(const std::string& shader, Defines defines = {});
  Kernel graphics(const GraphicsKernelDesc& desc);
  // A fragment shader that writes every pixel of images of one size; see PassDeclaration::fullscreen().
  Kernel fullscreen(const std::string& fragment, const std::vector<std::string>& colors,
                    Defines defines = {});

 private:
  friend void buildSteps(PassInstance& pass, const std::vector<PlannedStep>& planned);
  // onHost: the kernel is compiled for the host, and needs no pipeline.
  Kernel compute(const std::string& shader, const Defines& defines, bool onHost);
  PassInstance& pass_;
};

// One dispatch or draw under construction:
//   ctx.use(kernel).constant("count", n).dispatchThreads(n);
// Push constants that bear the name of a parameter (in camelCase), `frameIndex`, `seed` and `foveaRadius` (that of the
// pass's view) are filled in automatically. A push constant that is left unset throws Error(Internal) naming it, an unresolved binding
// throws Error(BadInput).
class Commands {
 public:
  template <class T>
  Commands& constant(std::string_view name, const T& value) {
    return constantBytes(name, &value, sizeof(T));
  }
  // Binds one mip level of an image port under a name of the shader.
  Commands& mip(std::string_view name, std::string_view port, uint32_t level);
  // Binds part of a buffer port, for uniform buffers that exceed the device's maximum range.
  Commands& range(std::string_view port, uint64_t offset, uint64_t bytes);
  // Whatever this command and the one before it do to the same resource may happen in any order (integer atomics, or
  // parts that do not overlap), so that both may run at the same time.
  Commands& together();
  void dispatch(uint32_t groupsX, uint32_t groupsY = 1, uint32_t groupsZ = 1);
  void dispatchThreads(uint32_t x, uint32_t y = 1, uint32_t z = 1);  // rounded up to whole workgroups
  void dispatchOver(std::string_view port);  // one thread per texel of every layer or slice, or per element
  void dispatchIndirect(std::string_view bufferPort, uint64_t offset = 0);
  void drawFullscreen();  // for kernels made by PrepareContext::fullscreen
  void draw(uint32_t vertices, uint32_t instances = 1, uint32_t firstInstance = 0);
  // Triangles of the scene, whose indices are those of scene::GpuScene. Shaders know vertex, layer and triangle from
  // scene/drawn_vertex.glsl and scene/drawn_triangle.glsl.
  void drawTriangles(VkBuffer indices, uint32_t first, uint32_t count, uint32_t instances = 1);
  void drawIndirect(std::string_view bufferPort, uint64_t offset, uint32_t count, uint32_t stride);

 private:
  friend class RecordContext;
  Commands(RecordContext& context, KernelState& kernel);
  Commands& constantBytes(std::string_view name, const void* data, size_t bytes);
  void checkConstants() const;
  void begin(const uint32_t* indirect);
  void flush(const uint32_t* indirect = nullptr);  // access through which the command's size is read
  void runOnHost(uint32_t groupsX, uint32_t groupsY, uint32_t groupsZ, const uint32_t* indirect = nullptr,
                 uint64_t offset = 0);
  RecordContext& context_;
  KernelState& kernel_;
  std::byte constants_[128]{};
  uint64_t constantsSet_ = 0;  // one bit per constant
  bool together_ = false;
};

struct Attachment {
  std::string port;
  enum class Load { Clear, Keep, Discard } load = Load::Clear;
  VkClearValue clear{};
};

// Passed to Pass::record() once per frame. Commands are ordered by what their shaders read and write, so a pass needs
// no barriers between them.
class RecordContext : public PassContext {
 public:
  RecordContext(PassInstance& pass, VkCommandBuffer cmd, const scene::Frame& frame, uint64_t frameNumber);
  VkCommandBuffer cmd() const { return cmd_; }
  gpu::Device& device() const;
  const scene::Frame& frame() const { return frame_; }
  const scene::View& view() const;  // the view that the graph file assigns to this pass
  uint64_t frameNumber() const { return frameNumber_; }
  bool firstFrame() const;  // kept and history resources were just zeroed
  // What the pass remembers from frame to frame, such as whether it has voxelised what never moves; always of the same
  // type. It begins as T(), and does so again together with what the pass keeps for the scene. It goes on in the next
  // plan if neither the pass nor any pass from which its inputs come has changed. A member of the pass would begin anew
  // with each plan.
  template <class T>
  T& memory() {
    std::any& memory = remembered();
    if (!memory.has_value()) memory.emplace<T>();
    return *std::any_cast<T>(&memory);
  }
  gpu::Image& image(std::string_view port) const;  // "radiance" or "surface.position"
  gpu::Buffer& buffer(std::string_view port) const;

  void runSteps();                  // every declared step whose condition holds, in order
  void run(std::string_view step);  // one declared step; nothing if its condition does not hold
  // A declared step with its constants set, to be completed and dispatched by the pass.
  Commands step(std::string_view step);
  Commands use(Kernel kernel);
  // Dynamic rendering into whole images, or into `area` of them, to which viewport and scissor are set. `kernels` are
  // those with which `body` draws, so that everything they read is there when it starts. `layers` is the number of
  // array layers. If there are several, instances go into the layers of their numbers (scene/drawn_vertex.glsl), and a
  // device without shaderOutputLayer runs `body` once for each of them.
  void render(const std::vector<Attachment>& colors, const Attachment* depth, std::span<const Kernel> kernels,
              const std::function<void()>& body, uint32_t layers = 1);
  void render(const std::vector<Attachment>& colors, const Attachment* depth, std::span<const Kernel> kernels,
              VkRect2D area, const std::function<void()>& body, uint32_t layers = 1);
  void fill(std::string_view bufferPort, uint32_t word);  // whole buffer; needs TransferWrite
  // Clears a whole image. Needs TransferWrite.
  void clear(std::string_view imagePort, VkClearColorValue value);
  // Copies whole images of equal size and format without mips. Needs TransferRead on the source and TransferWrite on
  // the destination.
  void copy(std::string_view imageFrom, std::string_view imageTo);
  // Makes everything recorded before visible to everything after. Only for commands that a pass records itself through
  // cmd().
  void barrier();
  // Sets a counter from the CPU. Shaders count through `uint counters[]` in set 0, in the order of declaration.
  void counter(std::string_view name, double value);

 private:
  friend class Commands;
  std::any& remembered();
  Commands start(uint32_t index);
  void runStep(uint32_t index);
  PassInstance& pass_;
  VkCommandBuffer cmd_;
  const scene::Frame& frame_;
  uint64_t frameNumber_;
};

template <std::invocable<const RecordContext&> Function>
StepSpec& StepSpec::constant(std::string constant, Function function) {
  frameConstants.emplace_back(
      [name = std::move(constant), function](const RecordContext& ctx, Commands& commands) {
        commands.constant(name, function(ctx));
      });
  return *this;
}

// Passed to Pass::execute() of host passes once per frame. Inputs and outputs are plain memory; images are tightly
// packed, layer after layer.
class HostContext : public PassContext {
 public:
  HostContext(PassInstance& pass, const scene::Frame& frame, uint64_t frameNumber);
  const scene::Frame& frame() const { return frame_; }
  const scene::View& view() const;
  uint64_t frameNumber() const { return frameNumber_; }
  bool firstFrame() const;
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
  // For long-running passes: reports the completed share of the work, from 0 to 1. Call it from time to time on the
  // thread of execute(). If it returns false, nobody waits for the result any more: finish soon, with the outputs in
  // their current state.
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
  virtual void record(RecordContext& ctx) { ctx.runSteps(); }  // for compute and graphics passes
  virtual void execute(HostContext&) {}                        // for host passes
};

// ---- Registration ----------------------------------------------------------------------------------------------

// The mark that FOVEA_PASS (fovea/registration.h) gives to a pass: the sizes of the types that it exchanges with the
// framework.
constexpr Abi passAbi() {
  return makeAbi({sizeof(PassDeclaration), sizeof(PortSpec), sizeof(MemberSpec), sizeof(ResourceSpec),
                  sizeof(SizeExpr::Term), sizeof(StepSpec), sizeof(PassContext), sizeof(ParameterSpec),
                  sizeof(CounterSpec), sizeof(Parameters), sizeof(PrepareContext), sizeof(RecordContext),
                  sizeof(HostContext), sizeof(Commands), sizeof(GraphicsKernelDesc), sizeof(Attachment),
                  sizeof(Pass), sizeof(Defines)});
}

}  // namespace fovea::graph
