// What a pass says about itself, once, as data: ports, parameters, counters. Validation, schema, help, allocation,
// barriers and shader bindings all follow from it. Nothing here needs a device.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

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
  enum class Op : uint8_t { Constant, ViewWidth, ViewHeight, Parameter, PortWidth, PortHeight, PortLayers, PortCount,
                            Environment, Add, Sub, Mul, Div /* rounds up */, Min, Max };
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
ResourceSpec image2D(VkFormat format = VK_FORMAT_UNDEFINED);  // inputs; an output of this form has the view's size
ResourceSpec image2DArray(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr layers);
ResourceSpec image3D(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr depth, SizeExpr mips = 1);
ResourceSpec buffer(std::string element, uint32_t stride, SizeExpr count = 1);

// How a pass touches a resource. Stages follow from the pass kind.
enum class Usage : uint32_t {
  None = 0,
  Sampled = 1 << 0,          // texelFetch or sampler
  StorageRead = 1 << 1,      // storage image or buffer
  StorageWrite = 1 << 2,
  ColorAttachment = 1 << 3,
  DepthAttachment = 1 << 4,  // tested and written
  Uniform = 1 << 5,          // uniform buffer
  TexelRead = 1 << 6,        // uniform texel buffer
  Indirect = 1 << 7,
  TransferRead = 1 << 8,
  TransferWrite = 1 << 9,
  HostRead = 1 << 10,        // host passes
  HostWrite = 1 << 11,
};
constexpr Usage operator|(Usage a, Usage b) { return Usage(uint32_t(a) | uint32_t(b)); }
constexpr bool any(Usage a, Usage b) { return (uint32_t(a) & uint32_t(b)) != 0; }

// ---- Ports -----------------------------------------------------------------------------------------------------

enum class Direction : uint8_t {
  Input,
  Output,
  InOut,    // wired like an input; the pass updates it in place and offers the new version under the same name
  Scratch,  // an output nobody can wire: memory of the pass for one frame
};

enum class Lifetime : uint8_t {
  Transient,   // this frame only; its memory is shared with others
  View,        // kept from frame to frame; zeroed at the first frame, on a camera cut and on a resize
  Scene,       // kept while the scene stays loaded; zeroed at the first frame
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
  PortSpec& keep(Lifetime l) { lifetime = l; return *this; }
  PortSpec& makeOptional() { optional = true; return *this; }
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
  bool usesView = false;      // looks through a camera: takes `view` in the graph file
  bool sideEffects = false;   // never culled
  std::vector<PortSpec> ports;
  std::vector<ParameterSpec> parameters;
  std::vector<CounterSpec> counters;

  PassDeclaration& view() { usesView = true; return *this; }
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

}  // namespace fovea::graph
