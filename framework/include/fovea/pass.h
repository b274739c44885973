// A pass consists of a declaration (plain data), kernels that are built once per plan, and commands that
// are recorded every frame.
//
// The declaration states once which resources the pass reads and writes and which parameters and counters it
// has. Validation, the JSON schema, help texts, memory allocation, barriers and shader bindings are all derived
// from it. Functions whose signatures name types of namespace gpu are meant for the project's own passes;
// plug-ins do not need them.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "fovea/registration.h"

namespace fovea::gpu {
class Device;
class Buffer;
class Image;
class Pipeline;
}  // namespace fovea::gpu

namespace fovea::scene {
struct Frame;  // defined in fovea/scene.h
struct View;
}  // namespace fovea::scene

namespace fovea::graph {

// ---- Parameters ------------------------------------------------------------------------------------------------

using Value = std::variant<bool, int64_t, double, std::string>;

struct ParameterSpec {
  enum class Type { Bool, Int, Real, Choice, Text };
  std::string name;  // snake_case in JSON; shaders see it in camelCase
  std::string doc;
  Type type = Type::Real;
  Value defaultValue;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices;
  std::string unit;
};

ParameterSpec integer(int64_t defaultValue, int64_t min, int64_t max);
ParameterSpec real(double defaultValue, double min, double max, std::string unit = {});
ParameterSpec flag(bool defaultValue);
ParameterSpec choice(std::string defaultValue, std::vector<std::string> choices);
ParameterSpec text(std::string defaultValue);

// The parameter values of one pass instance, in the order of its declaration. Asking for an unknown name or for a
// value of the wrong type is a defect of the pass and throws Error(Internal).
class Parameters {
 public:
  Parameters() = default;
  // Takes one value per entry of `specs` from `all`, starting at `first`. `all` holds the values of every pass of a
  // graph and is owned by the graph, because thousands of small arrays would cost more than their contents.
  Parameters(const std::vector<ParameterSpec>* specs, const std::vector<Value>* all, size_t first)
      : specs_(specs), all_(all), first_(first) {}
  int64_t integer(std::string_view name) const;
  double real(std::string_view name) const;  // integers are converted
  bool flag(std::string_view name) const;
  const std::string& text(std::string_view name) const;  // for both text and choice
  const Value* find(std::string_view name) const;
  const std::vector<ParameterSpec>& specs() const { return *specs_; }
  std::span<const Value> values() const {
    return specs_ ? std::span<const Value>(*all_).subspan(first_, specs_->size()) : std::span<const Value>();
  }

 private:
  const std::vector<ParameterSpec>* specs_ = nullptr;
  const std::vector<Value>* all_ = nullptr;
  size_t first_ = 0;
};

// ---- Sizes -----------------------------------------------------------------------------------------------------

// An integer expression over the size of the view, parameters and the sizes of input ports. It is evaluated when a
// graph is bound.
class SizeExpr {
 public:
  enum class Op : uint8_t {
    Constant,
    ViewWidth,
    ViewHeight,
    Parameter,
    PortWidth,
    PortHeight,
    PortLayers,
    PortCount,
    Environment,
    Add,
    Sub,
    Mul,
    Div /* rounds up */,
    Min,
    Max
  };
  struct Term {
    Op op;
    int64_t constant = 0;
    std::string name;  // name of a parameter or environment quantity, or "port" or "port.member"
  };
  SizeExpr() : SizeExpr(1) {}
  SizeExpr(int64_t constant) : terms_{{Op::Constant, constant, {}}} {}  // NOLINT: implicit on purpose
  SizeExpr(Op leaf, std::string name) : terms_{{leaf, 0, std::move(name)}} {}
  SizeExpr(const SizeExpr& a, const SizeExpr& b, Op op);
  const std::vector<Term>& terms() const { return terms_; }  // in postfix order
  std::string print() const;                                 // for help texts, e.g. "view.width / 4"

 private:
  std::vector<Term> terms_;
};
SizeExpr operator+(const SizeExpr& a, const SizeExpr& b);
SizeExpr operator-(const SizeExpr& a, const SizeExpr& b);
SizeExpr operator*(const SizeExpr& a, const SizeExpr& b);
SizeExpr ceilDiv(const SizeExpr& a, const SizeExpr& b);
SizeExpr min(const SizeExpr& a, const SizeExpr& b);
SizeExpr max(const SizeExpr& a, const SizeExpr& b);
SizeExpr viewWidth();
SizeExpr viewHeight();
SizeExpr parameter(std::string name);
SizeExpr widthOf(std::string port);
SizeExpr heightOf(std::string port);
SizeExpr layersOf(std::string port);
SizeExpr countOf(std::string port);
// A number that describes the scene: "scene.triangles", "scene.static_triangles", "scene.vertices",
// "scene.shadow_layers" or "scene.lights". It is at least 1.
SizeExpr environment(std::string name);

// ---- Resources -------------------------------------------------------------------------------------------------

enum class ResourceKind : uint8_t { Image, Buffer };

struct ResourceSpec {
  ResourceKind kind = ResourceKind::Image;
  // Images. On an input, VK_FORMAT_UNDEFINED accepts any format with floating-point reads.
  VkFormat format = VK_FORMAT_UNDEFINED;
  bool volume = false;  // 3D image
  bool array = false;   // array image, even with a single layer
  SizeExpr width, height, depth, layers, mips;
  // Buffers of `count` elements of `stride` bytes each. Ports are matched by the name of the element type.
  std::string element;
  uint32_t stride = 0;
  SizeExpr count;
};

ResourceSpec image2D(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr mips = 1);
// For inputs. An output declared this way has the size of the view.
ResourceSpec image2D(VkFormat format = VK_FORMAT_UNDEFINED);
ResourceSpec image2DArray(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr layers);
ResourceSpec image3D(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr depth, SizeExpr mips = 1);
ResourceSpec buffer(std::string element, uint32_t stride, SizeExpr count = 1);

// How a pass accesses a resource. The pipeline stages follow from the kind of pass.
enum class Usage : uint32_t {
  None = 0,
  Sampled = 1 << 0,      // read with texelFetch or through a sampler
  StorageRead = 1 << 1,  // storage image or buffer
  StorageWrite = 1 << 2,
  ColorAttachment = 1 << 3,
  DepthAttachment = 1 << 4,  // tested and written
  Uniform = 1 << 5,          // uniform buffer
  TexelRead = 1 << 6,        // uniform texel buffer
  Indirect = 1 << 7,
  TransferRead = 1 << 8,
  TransferWrite = 1 << 9,
  HostRead = 1 << 10,  // host passes only
  HostWrite = 1 << 11,
};
constexpr Usage operator|(Usage a, Usage b) { return Usage(uint32_t(a) | uint32_t(b)); }
constexpr bool any(Usage a, Usage b) { return (uint32_t(a) & uint32_t(b)) != 0; }

// ---- Ports -----------------------------------------------------------------------------------------------------

enum class Direction : uint8_t {
  Input,
  Output,
  InOut,    // wired like an input, updated in place and offered as a new version under the same name
  Scratch,  // memory of the pass for one frame; cannot be wired
};

enum class Lifetime : uint8_t {
  Transient,  // for one frame; its memory is shared with other resources
  View,       // kept from frame to frame; zeroed at the first frame, on a camera cut and on a resize
  Scene,      // kept while the scene stays loaded; zeroed at the first frame
};

struct MemberSpec {
  std::string name;  // "" for the only member of a plain port
  std::string doc;
  ResourceSpec resource;
  Usage usage = Usage::None;
};

struct PortSpec {
  std::string name;
  std::string doc;
  Direction direction = Direction::Input;
  std::string bundle;  // type name of the bundle; "" for a plain port
  std::vector<MemberSpec> members;
  Lifetime lifetime = Lifetime::Transient;  // for outputs and scratch
  bool optional = false;                    // for inputs

  // These change the port in place, so that calls can be chained: d.output(...).keep(Lifetime::View)
  PortSpec& keep(Lifetime l) {
    lifetime = l;
    return *this;
  }
  PortSpec& makeOptional() {
    optional = true;
    return *this;
  }
};

struct CounterSpec {
  std::string name, doc;
};

enum class PassKind : uint8_t { Compute, Graphics, ComputeAndGraphics, Host };

struct PassDeclaration {
  PassDeclaration(std::string typeName, std::string docText, PassKind passKind = PassKind::Compute)
      : type(std::move(typeName)), doc(std::move(docText)), kind(passKind) {}

  std::string type;  // name of the pass type and of its folder, e.g. "edge-filter"
  std::string doc;   // one line
  PassKind kind;
  bool usesView = false;     // renders from a camera, which `view` in the graph file selects
  bool sideEffects = false;  // never culled
  std::vector<PortSpec> ports;
  std::vector<ParameterSpec> parameters;
  std::vector<CounterSpec> counters;

  PassDeclaration& view() {
    usesView = true;
    return *this;
  }
  PortSpec& input(std::string name, ResourceSpec resource, Usage usage, std::string doc);
  PortSpec& output(std::string name, ResourceSpec resource, Usage usage, std::string doc);
  PortSpec& inout(std::string name, ResourceSpec resource, Usage usage, std::string doc);
  PortSpec& scratch(std::string name, ResourceSpec resource, Usage usage, std::string doc);
  PortSpec& input(std::string name, std::string bundle, std::vector<MemberSpec> members, std::string doc);
  PortSpec& output(std::string name, std::string bundle, std::vector<MemberSpec> members, std::string doc);
  PortSpec& inout(std::string name, std::string bundle, std::vector<MemberSpec> members, std::string doc);
  PassDeclaration& parameter(std::string name, ParameterSpec spec, std::string doc);
  PassDeclaration& counter(std::string name, std::string doc);

  const PortSpec* findPort(std::string_view name) const;
};

MemberSpec member(std::string name, ResourceSpec resource, Usage usage, std::string doc = {});

// The only naming rule between JSON and shaders: snake_case and dotted paths become camelCase.
// "surface.position" -> "surfacePosition", "vpl_count" -> "vplCount".
std::string shaderName(std::string_view path);

// ---- Kernels and contexts --------------------------------------------------------------------------------------

// Preprocessor macros with which a shader is compiled.
using Defines = std::map<std::string, std::string>;

struct PassInstance;  // private to the executor
struct KernelState;

// A pipeline whose bindings are resolved by name against the ports of the pass. Cheap to copy.
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

// Passed to Pass::prepare() once per plan. All kernels are built here, so that the frame loop compiles nothing.
class PrepareContext {
 public:
  explicit PrepareContext(PassInstance& pass) : pass_(pass) {}
  gpu::Device& device() const;
  const Parameters& parameters() const;
  bool has(std::string_view port) const;  // whether an optional input is wired
  // Whether an output, or a member of one, is read by another pass or in the next frame, or is an output of the
  // graph. If it is not, the pass need not write it.
  bool isRead(std::string_view path) const;
  VkExtent3D extent(std::string_view port) const;
  uint32_t layers(std::string_view port) const;
  uint64_t count(std::string_view port) const;  // number of elements in a buffer
  // Every binding of set 0 must be a port ("radiance"), a member ("surface.position", bound as surfacePosition), a
  // sampler (linearClamp, linearRepeat, nearestClamp or nearestRepeat) or `counters`, or be bound by hand in
  // record(). Throws Error(BadInput) naming the shader, the binding and, where one is similar, the nearest port.
  Kernel compute(const std::string& shader, Defines defines = {});
  Kernel graphics(const GraphicsKernelDesc& desc);
  // A fragment shader that writes every pixel of images of one size (ports or members declared with
  // Usage::ColorAttachment, in the order of the shader's outputs). On a CPU device, a store to a storage image costs
  // several times as much as such an output.
  Kernel fullscreen(const std::string& fragment, const std::vector<std::string>& colors,
                    Defines defines = {});

 private:
  PassInstance& pass_;
};

class RecordContext;

// One dispatch or draw under construction:
//   ctx.use(kernel).constant("count", n).dispatchThreads(n);
// Push constants that bear the name of a parameter (in camelCase), `frameIndex` and `seed` are filled in
// automatically. A push constant that is left unset throws Error(Internal) naming it, an unresolved binding
// throws Error(BadInput).
class Commands {
 public:
  template <class T>
  Commands& constant(std::string_view name, const T& value) {
    return constantBytes(name, &value, sizeof(T));
  }
  Commands& bind(std::string_view name, VkImageView view);  // e.g. one mip level, in the layout of the port
  Commands& bind(std::string_view name, const gpu::Buffer& buffer, uint64_t offset, uint64_t range);
  // Binds part of a buffer port, for uniform buffers that exceed the device's maximum range.
  Commands& range(std::string_view port, uint64_t offset, uint64_t bytes);
  void dispatch(uint32_t groupsX, uint32_t groupsY = 1, uint32_t groupsZ = 1);
  void dispatchThreads(uint32_t x, uint32_t y = 1, uint32_t z = 1);  // rounded up to whole workgroups
  void dispatchOver(std::string_view imagePort);  // one thread per texel of every layer or slice
  void dispatchIndirect(std::string_view bufferPort, uint64_t offset = 0);
  void drawFullscreen();  // for kernels made by PrepareContext::fullscreen
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
  uint64_t constantsSet_ = 0;  // one bit per constant
};

struct Attachment {
  std::string port;
  enum class Load { Clear, Keep, Discard } load = Load::Clear;
  VkClearValue clear{};
};

// Passed to Pass::record() once per frame. All look-ups use the names of the declaration.
class RecordContext {
 public:
  RecordContext(PassInstance& pass, VkCommandBuffer cmd, const scene::Frame& frame, uint64_t frameNumber);
  VkCommandBuffer cmd() const { return cmd_; }
  gpu::Device& device() const;
  const Parameters& parameters() const;
  const scene::Frame& frame() const { return frame_; }
  const scene::View& view() const;  // the view that the graph file assigns to this pass
  uint64_t frameNumber() const { return frameNumber_; }
  bool has(std::string_view port) const;
  bool firstFrame() const;                         // kept and history resources were just zeroed
  gpu::Image& image(std::string_view port) const;  // "radiance" or "surface.position"
  gpu::Buffer& buffer(std::string_view port) const;
  VkExtent3D extent(std::string_view port) const;
  uint64_t count(std::string_view port) const;  // number of elements in a buffer

  Commands use(Kernel kernel);
  // Dynamic rendering into whole images, or into `area` of them, to which viewport and scissor are set. `layers` is
  // the number of array layers.
  void render(const std::vector<Attachment>& colors, const Attachment* depth,
              const std::function<void()>& body, uint32_t layers = 1);
  void render(const std::vector<Attachment>& colors, const Attachment* depth, VkRect2D area,
              const std::function<void()>& body, uint32_t layers = 1);
  void fill(std::string_view bufferPort, uint32_t word);  // whole buffer; needs TransferWrite
  // Clears a whole image. Needs TransferWrite.
  void clear(std::string_view imagePort, VkClearColorValue value);
  // Copies whole colour images of equal size and format without mips. Needs TransferRead on the source and
  // TransferWrite on the destination.
  void copy(std::string_view imageFrom, std::string_view imageTo);
  // Separates commands of this pass that depend on each other: everything recorded before is
  // visible to everything after.
  void barrier();
  // Sets a counter from the CPU. Shaders count through `uint counters[]` in set 0, in the order of declaration.
  void counter(std::string_view name, double value);

 private:
  friend class Commands;
  PassInstance& pass_;
  VkCommandBuffer cmd_;
  const scene::Frame& frame_;
  uint64_t frameNumber_;
};

// Passed to Pass::execute() of host passes once per frame. Inputs and outputs are plain memory; images are tightly
// packed, layer after layer.
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
  // For passes that run long: reports the completed share of the work, from 0 to 1. Call it from time to time on the
  // thread of execute(). If it returns false, nobody is waiting any longer: finish soon, with the outputs as good as
  // they are by then.
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
  virtual void record(RecordContext&) {}  // for compute and graphics passes
  virtual void execute(HostContext&) {}   // for host passes
};

// ---- Registration ----------------------------------------------------------------------------------------------

// The mark that FOVEA_PASS (fovea/registration.h) gives to a pass: what it exchanges with the framework.
constexpr Abi passAbi() {
  return makeAbi({sizeof(PassDeclaration), sizeof(PortSpec), sizeof(MemberSpec), sizeof(ResourceSpec),
                  sizeof(SizeExpr::Term), sizeof(ParameterSpec), sizeof(CounterSpec), sizeof(Parameters),
                  sizeof(PrepareContext), sizeof(RecordContext), sizeof(HostContext), sizeof(Commands),
                  sizeof(GraphicsKernelDesc), sizeof(Attachment), sizeof(Pass), sizeof(Defines)});
}

}  // namespace fovea::graph
