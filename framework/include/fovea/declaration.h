// What a pass is, as plain data: its resources, parameters, counters and steps.
//
// The declaration states once which resources the pass reads and writes, which parameters and counters it has, and
// which steps it consists of. Validation, the JSON schema, help texts, memory allocation, barriers, shader bindings and
// the rows of the timings are all derived from it.
#pragma once

#include <vulkan/vulkan.h>

#include <concepts>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "fovea/error.h"

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
  // What a choice can be. Of a whole number or a flag, as text: the only values that it can have; empty if it can have
  // every value in its range.
  std::vector<std::string> choices;
  std::string unit;
};

ParameterSpec integer(int64_t defaultValue, int64_t min, int64_t max);
ParameterSpec integer(int64_t defaultValue, std::initializer_list<int64_t> allowed);
ParameterSpec real(double defaultValue, double min, double max, std::string unit = {});
ParameterSpec flag(bool defaultValue);
ParameterSpec choice(std::string defaultValue, std::vector<std::string> choices);
ParameterSpec text(std::string defaultValue);

// What belongs to the frame and not to one pass: materials, the fovea, the jitter of the views. A graph sets these once,
// under `view`, or else the run does. Passes find them among their parameters, and expressions use them, under names such
// as `view.materials`.
const std::vector<ParameterSpec>& viewParameters();
inline constexpr std::string_view kViewPrefix = "view.";
// The parameter of this name among a pass's own or, with the prefix, those of the view. Null if there is none.
const ParameterSpec* findParameter(const std::vector<ParameterSpec>& own, std::string_view name);

// The parameter values of one pass instance, in the order of its declaration, and those of viewParameters(). Asking for
// an unknown name or for a value of the wrong type is a defect of the pass and throws Error(Internal).
class Parameters {
 public:
  Parameters() = default;
  // Takes one value per entry of `specs` from `all`, starting at `first`. `all` holds the values of viewParameters(), and
  // then those of every pass of a graph. The graph owns it, because thousands of small arrays would cost more than their
  // contents.
  Parameters(const std::vector<ParameterSpec>* specs, const std::vector<Value>* all, size_t first)
      : specs_(specs), all_(all), first_(first) {}
  int64_t integer(std::string_view name) const;
  double real(std::string_view name) const;  // integers are converted
  bool flag(std::string_view name) const;
  const std::string& text(std::string_view name) const;  // for both text and choice
  const Value* find(std::string_view name) const;
  const ParameterSpec* findSpec(std::string_view name) const;
  std::span<const Value> values() const {
    return specs_ ? std::span<const Value>(*all_).subspan(first_, specs_->size()) : std::span<const Value>();
  }

 private:
  const std::vector<ParameterSpec>* specs_ = nullptr;
  const std::vector<Value>* all_ = nullptr;
  size_t first_ = 0;
};

// ---- Sizes -----------------------------------------------------------------------------------------------------

// An integer expression over the size of the view, parameters (also `view.materials`) and the sizes of input ports. It
// is evaluated when a graph is bound. Steps may also depend on whether ports are wired or read and on the value of choices; conditions are
// 0 or 1.
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
    Wired,        // 1 if the optional input is wired, else 0
    Read,         // 1 if something reads the output, else 0
    ParameterIs,  // 1 if the choice has this value, else 0
    Add,
    Sub,
    Mul,
    Div /* rounds up */,
    Min,
    Max,
    Same,   // 1 if the two are equal, else 0
    AtMost  // 1 if the first is not greater than the second, else 0
  };
  struct Term {
    Op op;
    int64_t constant = 0;
    std::string name;         // name of a parameter or environment quantity, or "port" or "port.member"
    std::string choice = {};  // of ParameterIs
  };
  SizeExpr() : SizeExpr(1) {}
  SizeExpr(int64_t constant) : terms_{{Op::Constant, constant, {}}} {}  // NOLINT: implicit on purpose
  SizeExpr(Op leaf, std::string name) : terms_{{leaf, 0, std::move(name)}} {}
  explicit SizeExpr(std::vector<Term> postfix) : terms_(std::move(postfix)) {}
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
// "scene.lights", "scene.shadow_layers" or "scene.shadow_texels", the most texels that a shadow map may have on a side.
// Each is at least 1.
SizeExpr environment(std::string name);
SizeExpr wired(std::string port);  // 1 if an optional input is wired, else 0
// Conditions, for steps and requirements.
SizeExpr isRead(
    std::string path);  // for steps only: whether another pass or the next frame reads this output
SizeExpr is(std::string parameter, std::string choice);  // whether a parameter has this choice
SizeExpr same(const SizeExpr& a, const SizeExpr& b);     // a == b
SizeExpr atMost(const SizeExpr& a, const SizeExpr& b);   // a <= b
SizeExpr operator!(const SizeExpr& a);
SizeExpr operator&&(const SizeExpr& a, const SizeExpr& b);
SizeExpr operator||(const SizeExpr& a, const SizeExpr& b);

// ---- Resources -------------------------------------------------------------------------------------------------

enum class ResourceKind : uint8_t { Image, Buffer };

struct ResourceSpec {
  ResourceKind kind = ResourceKind::Image;
  // Images. On an input, VK_FORMAT_UNDEFINED accepts any format with floating-point reads.
  VkFormat format = VK_FORMAT_UNDEFINED;
  bool volume = false;  // 3D image
  bool array = false;   // array image, even with a single layer
  SizeExpr width, height, depth, layers, mips;
  // Images of outputs: with which power of light their rgb grows, 1 for radiance, 2 for its variance. They hold it times
  // that power of Frame::preExposure, and what is read back of them is in the units of the scene, as 32-bit floats.
  uint32_t light = 0;
  // Buffers of `count` elements of `stride` bytes each. Ports are matched by the name of the element type.
  std::string element;
  uint32_t stride = 0;
  SizeExpr count;
};

ResourceSpec image2D(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr mips = 1);
// For inputs. An output declared this way has the size of the view.
ResourceSpec image2D(VkFormat format = VK_FORMAT_UNDEFINED);
// Marks an image as one of light, see ResourceSpec::light.
ResourceSpec ofLight(ResourceSpec image, uint32_t power = 1);
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
  SizeExpr condition;                       // 0 leaves an optional input open, however it is wired

  // These change the port in place, so that calls can be chained: d.output(...).keep(Lifetime::View)
  PortSpec& keep(Lifetime l) {
    lifetime = l;
    return *this;
  }
  PortSpec& makeOptional() {
    optional = true;
    return *this;
  }
  // An optional input that counts as wired only if the condition, over parameters of the pass, holds. Otherwise passes
  // that are needed only for this input do not run.
  PortSpec& when(SizeExpr isTrue) {
    optional = true;
    condition = std::move(isTrue);
    return *this;
  }
};

struct CounterSpec {
  std::string name, doc;
};

// What has to hold of a pass in a graph: of its parameters, of which inputs are wired, and of their sizes. It is checked
// when the graph is bound, and values of parameters that contradict it are not offered to users.
struct RequirementSpec {
  // 0 if it does not hold. Real parameters are rounded up. What is over the size of an input that is not wired holds.
  SizeExpr condition;
  std::string message;  // what is wrong then: "show `age` needs the input `state`"
  std::string remedy;   // "wire `state`, or show something else"
};

// ---- Steps -----------------------------------------------------------------------------------------------------

class Commands;
class RecordContext;

// One kernel of a pass, or one fill, clear or copy. Which resources a kernel reads and writes follows from its shader:
// from the kind of each binding and from the qualifiers `readonly` and `writeonly`; without one of these, a storage
// binding counts as both, as far as the port allows. The framework places the barriers between steps and times each
// step.
struct StepSpec {
  enum class Action : uint8_t {
    Dispatch,    // a compute shader
    Fullscreen,  // a fragment shader that writes every pixel of `targets`
    Fill,        // fills the buffer target[0] with `word`
    Clear,       // clears the image target[0] to `word` in all channels
    Copy,        // copies the image `source` to the image target[0]
  };
  enum class Size : uint8_t {
    Manual,    // record() says
    Groups,    // `size` work groups
    Threads,   // `size` threads, rounded up to whole groups
    Over,      // one thread per texel of the image `sizePort`, or per element of the buffer `sizePort`
    Indirect,  // work groups from the buffer `sizePort`, at `offset` bytes
  };
  std::string name;  // unique in the pass; the shader's file name without its ending unless given
  Action action = Action::Dispatch;
  std::string shader;
  SizeExpr condition;     // 0 leaves the step out of the plan
  bool together = false;  // may run at the same time as the step before it
  std::vector<std::pair<std::string, SizeExpr>> defines;
  std::vector<std::pair<std::string, SizeExpr>> constants;
  std::vector<std::function<void(const RecordContext&, Commands&)>> frameConstants;
  Size sizing = Size::Manual;
  SizeExpr size[3];
  std::string sizePort;
  uint64_t offset = 0;
  std::string source;
  std::vector<std::string> targets;  // ports, or members of ports
  std::string tileMask;              // says which tiles of `targets` a full-screen step draws; "" for all
  uint32_t word = 0;

  // These change the step in place, so that calls can be chained: d.step("blur.comp").define(...).over("image")
  StepSpec& called(std::string stepName);
  StepSpec& when(SizeExpr isTrue);
  // Whatever this step and the one before it do to the same resource may happen in any order.
  StepSpec& runTogether();
  StepSpec& define(std::string macro, SizeExpr value);
  // A push constant from sizes and parameters. Constants with the name of a parameter, `frameIndex`, `seed` and
  // `foveaRadius` are filled in automatically.
  StepSpec& constant(std::string constant, SizeExpr value);
  // A push constant from the frame: constant("exposure", [](const RecordContext& ctx) { return ...; })
  template <std::invocable<const RecordContext&> Function>
  StepSpec& constant(std::string constant, Function function);
  StepSpec& groups(SizeExpr x, SizeExpr y = 1, SizeExpr z = 1);
  StepSpec& threads(SizeExpr x, SizeExpr y = 1, SizeExpr z = 1);
  StepSpec& over(std::string port);
  StepSpec& indirect(std::string buffer, uint64_t offset = 0);
  // A full-screen step draws only the tiles whose texel of `mask` is not 0. The rest of its images keeps the values
  // that an earlier step of the pass has written, or else becomes 0. If `mask` is an input that is not wired, the step
  // draws everything. `mask` is an image of the format r8 with a texel for each tile. The sides of tiles are powers of
  // two: 16 pixels if 100 pixels have 7 texels. This saves the work outside the tiles, which a branch in a shader does
  // not do on a CPU device.
  StepSpec& tiles(std::string mask);
};

enum class PassKind : uint8_t { Compute, Graphics, ComputeAndGraphics, Host };

struct PassDeclaration {
  PassDeclaration(std::string typeName, std::string docText, PassKind passKind = PassKind::Compute)
      : type(std::move(typeName)), doc(std::move(docText)), kind(passKind) {}

  std::string type;  // name of the pass type and of its folder, e.g. "edge-filter"
  std::string doc;   // one line
  PassKind kind;
  bool usesView = false;     // renders from a camera, which `view` in the graph file selects
  bool tracesRays = false;   // on the device: its shaders include rays/trace.glsl
  bool sideEffects = false;  // never culled
  // Whether record() decides in each frame which steps run and in what order. A plan then contains the steps, but not
  // what they wait for, which is determined while they are recorded.
  bool stepsByFrame = false;
  std::vector<PortSpec> ports;
  std::vector<ParameterSpec> parameters;
  std::vector<CounterSpec> counters;
  std::vector<StepSpec> steps;
  std::vector<RequirementSpec> requirements;
  // For a pass that is declared in a file: the locations of "", "ports.NAME", "params.NAME", "steps.NAME" and
  // "requires[INDEX]" in it.
  std::shared_ptr<const std::map<std::string, SourceLocation>> places;

  PassDeclaration& view() {
    usesView = true;
    return *this;
  }
  PassDeclaration& rays() {
    tracesRays = true;
    return *this;
  }
  PassDeclaration& recorded() {
    stepsByFrame = true;
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
  PassDeclaration& require(SizeExpr condition, std::string message, std::string remedy);
  StepSpec& step(std::string computeShader);
  // Writes every pixel of images of one size (ports or members declared with Usage::ColorAttachment, in the order of
  // the shader's outputs). On a CPU device, a store to a storage image costs several times as much as such an output.
  StepSpec& fullscreen(std::string fragmentShader, std::vector<std::string> images);
  StepSpec& fill(std::string buffer, uint32_t word);  // needs TransferWrite
  StepSpec& clear(std::string image, uint32_t word);  // needs TransferWrite
  // Whole images of equal size and format without mips. Needs TransferRead and TransferWrite.
  StepSpec& copy(std::string imageFrom, std::string imageTo);

  SourceLocation placeOf(const std::string& path) const;  // unknown for a pass in C++
  const PortSpec* findPort(std::string_view name) const;
};

MemberSpec member(std::string name, ResourceSpec resource, Usage usage, std::string doc = {});
// How passes name a member of one of their ports: "surface.position", or "radiance" for a plain port.
std::string memberPath(const PortSpec& port, const MemberSpec& member);

// The only naming rule between JSON and shaders: snake_case and dotted paths become camelCase.
// "surface.position" -> "surfacePosition", "ray_count" -> "rayCount".
std::string shaderName(std::string_view path);

}  // namespace fovea::graph
