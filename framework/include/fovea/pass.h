// A pass: a declaration (data), kernels made once, and commands recorded every frame.
//
// The declaration says what a pass is, once: ports, parameters, counters. Validation, schema, help, allocation, barriers
// and shader bindings all follow from it. Members that return a type of namespace gpu are meant for the project's own
// passes; a plug-in does without them.
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

namespace fovea::gpu {
class Device;
class Buffer;
class Image;
class Pipeline;
}  // namespace fovea::gpu

namespace fovea::scene {
struct Frame;  // fovea/scene.h: views, gaze, lights, time and the scene itself
struct View;
}  // namespace fovea::scene

namespace fovea::graph {

// ---- Parameters ------------------------------------------------------------------------------------------------

using Value = std::variant<bool, int64_t, double, std::string>;

struct ParameterSpec {
  enum class Type { Bool, Int, Real, Choice, Text };
  std::string name;  // snake_case; a shader sees it as camelCase
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

// The values of one pass instance, in the order of its declaration. Asking for an unknown name or a wrong type is a
// defect of the pass and throws Error(Internal).
class Parameters {
 public:
  Parameters() = default;
  // One value for each of `specs`, from `first` on, in an array that the passes of a graph share and the graph owns:
  // thousands of small ones would cost more than what is in them.
  Parameters(const std::vector<ParameterSpec>* specs, const std::vector<Value>* all, size_t first)
      : specs_(specs), all_(all), first_(first) {}
  int64_t integer(std::string_view name) const;
  double real(std::string_view name) const;  // an integer converts
  bool flag(std::string_view name) const;
  const std::string& text(std::string_view name) const;  // text and choice
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

// Integer expression over the view's size, parameters and the sizes of input ports; evaluated when a graph is bound.
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
    std::string name;  // parameter, environment quantity, or "port" / "port.member"
  };
  SizeExpr() : SizeExpr(1) {}
  SizeExpr(int64_t constant) : terms_{{Op::Constant, constant, {}}} {}  // NOLINT: implicit on purpose
  SizeExpr(Op leaf, std::string name) : terms_{{leaf, 0, std::move(name)}} {}
  SizeExpr(const SizeExpr& a, const SizeExpr& b, Op op);
  const std::vector<Term>& terms() const { return terms_; }  // postfix order
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
// A number about the scene, from Environment::quantities: "scene.triangles", "scene.static_triangles", "scene.vertices",
// "scene.shadow_layers", "scene.lights". At least 1.
SizeExpr environment(std::string name);

// ---- Resources -------------------------------------------------------------------------------------------------

enum class ResourceKind : uint8_t { Image, Buffer };

struct ResourceSpec {
  ResourceKind kind = ResourceKind::Image;
  // Images. Format VK_FORMAT_UNDEFINED on an input: any format with floating-point reads.
  VkFormat format = VK_FORMAT_UNDEFINED;
  bool volume = false;  // 3D
  bool array = false;   // layers matter, also when there is one
  SizeExpr width, height, depth, layers, mips;
  // Buffers: `count` elements of `stride` bytes. The element name is the type that ports are matched by.
  std::string element;
  uint32_t stride = 0;
  SizeExpr count;
};

ResourceSpec image2D(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr mips = 1);
ResourceSpec image2D(
    VkFormat format = VK_FORMAT_UNDEFINED);  // inputs; an output of this form has the view's size
ResourceSpec image2DArray(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr layers);
ResourceSpec image3D(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr depth, SizeExpr mips = 1);
ResourceSpec buffer(std::string element, uint32_t stride, SizeExpr count = 1);

// How a pass touches a resource. Stages follow from the pass kind.
enum class Usage : uint32_t {
  None = 0,
  Sampled = 1 << 0,      // texelFetch or sampler
  StorageRead = 1 << 1,  // storage image or buffer
  StorageWrite = 1 << 2,
  ColorAttachment = 1 << 3,
  DepthAttachment = 1 << 4,  // tested and written
  Uniform = 1 << 5,          // uniform buffer
  TexelRead = 1 << 6,        // uniform texel buffer
  Indirect = 1 << 7,
  TransferRead = 1 << 8,
  TransferWrite = 1 << 9,
  HostRead = 1 << 10,  // host passes
  HostWrite = 1 << 11,
};
constexpr Usage operator|(Usage a, Usage b) { return Usage(uint32_t(a) | uint32_t(b)); }
constexpr bool any(Usage a, Usage b) { return (uint32_t(a) & uint32_t(b)) != 0; }

// ---- Ports -----------------------------------------------------------------------------------------------------

enum class Direction : uint8_t {
  Input,
  Output,
  InOut,  // wired like an input; the pass updates it in place and offers the new version under the same name
  Scratch,  // an output nobody can wire: memory of the pass for one frame
};

enum class Lifetime : uint8_t {
  Transient,  // this frame only; its memory is shared with others
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
  std::string bundle;  // type name of the bundle, "" for a plain port
  std::vector<MemberSpec> members;
  Lifetime lifetime = Lifetime::Transient;  // outputs and scratch
  bool optional = false;                    // inputs

  // In place, so that declarations read as a chain: d.output(...).keep(Lifetime::View)
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

  std::string type;  // "shadow-atlas": the folder's name
  std::string doc;   // one line
  PassKind kind;
  bool usesView = false;     // looks through a camera: takes `view` in the graph file
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

// The one naming rule between JSON and shaders: snake_case and dotted paths become camelCase.
// "gbuffer.position" -> "gbufferPosition", "vpl_count" -> "vplCount".
std::string shaderName(std::string_view path);

// ---- Kernels and contexts --------------------------------------------------------------------------------------

// Macros that a shader is compiled with.
using Defines = std::map<std::string, std::string>;

struct PassInstance;  // private to the executor
struct KernelState;

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
  std::string vertex, fragment;  // shader files; fragment may be empty
  Defines defines;
  std::vector<std::string> colors;  // ports or members, in the order of the fragment outputs
  std::string depth;                // port or member, "" for none
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
  Kernel compute(const std::string& shader, Defines defines = {});
  Kernel graphics(const GraphicsKernelDesc& desc);
  // A fragment shader that writes every pixel of images of one size (ports or members, Usage::ColorAttachment, in the
  // order of its outputs). On a CPU device a store to an image costs several times as much as such an output.
  Kernel fullscreen(const std::string& fragment, const std::vector<std::string>& colors,
                    Defines defines = {});

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
  void dispatchOver(std::string_view imagePort);  // one thread a texel (and layer or slice)
  void dispatchIndirect(std::string_view bufferPort, uint64_t offset = 0);
  void drawFullscreen();  // of PrepareContext::fullscreen
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
  const scene::View& view() const;  // the view the graph file gave this pass
  uint64_t frameNumber() const { return frameNumber_; }
  bool has(std::string_view port) const;
  bool firstFrame() const;                         // kept and history resources were just zeroed
  gpu::Image& image(std::string_view port) const;  // "radiance" or "gbuffer.position"
  gpu::Buffer& buffer(std::string_view port) const;
  VkExtent3D extent(std::string_view port) const;
  uint64_t count(std::string_view port) const;  // elements of a buffer

  Commands use(Kernel kernel);
  // Dynamic rendering over whole images (all layers when `layers` > 1).
  void render(const std::vector<Attachment>& colors, const Attachment* depth,
              const std::function<void()>& body, uint32_t layers = 1);
  void render(const std::vector<Attachment>& colors, const Attachment* depth, VkRect2D area,
              const std::function<void()>& body, uint32_t layers = 1);
  void fill(std::string_view bufferPort, uint32_t word);  // TransferWrite; whole buffer
  void clear(std::string_view imagePort,
             VkClearColorValue value);  // TransferWrite or StorageWrite; whole image
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
  virtual void record(RecordContext&) {}  // Compute and Graphics
  virtual void execute(HostContext&) {}   // Host
};

// ---- Registration ----------------------------------------------------------------------------------------------

// Adds a type of pass to those that the process knows; what is wrong with it is reported when the program starts.
struct Registration {
  Registration(PassDeclaration declaration, std::unique_ptr<Pass> (*factory)());
};

}  // namespace fovea::graph

// At namespace scope in the pass's source file. The class has `static fovea::graph::PassDeclaration declaration()`.
#define FOVEA_PASS(Class)                                         \
  static const ::fovea::graph::Registration registration_##Class( \
      Class::declaration(),                                       \
      []() -> std::unique_ptr<::fovea::graph::Pass> { return std::make_unique<Class>(); })
