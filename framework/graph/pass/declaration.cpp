#include "fovea/declaration.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "fovea/error.h"

namespace fovea::graph {

// ---- Parameters --------------------------------------------------------------------------------------

ParameterSpec integer(int64_t defaultValue, int64_t min, int64_t max) {
  ParameterSpec spec;
  spec.type = ParameterSpec::Type::Int;
  spec.defaultValue = defaultValue;
  spec.min = static_cast<double>(min);
  spec.max = static_cast<double>(max);
  return spec;
}

ParameterSpec integer(int64_t defaultValue, std::initializer_list<int64_t> allowed) {
  ParameterSpec spec = integer(defaultValue, std::min(allowed), std::max(allowed));
  for (const int64_t value : allowed) spec.choices.push_back(std::to_string(value));
  return spec;
}

ParameterSpec real(double defaultValue, double min, double max, std::string unit) {
  ParameterSpec spec;
  spec.type = ParameterSpec::Type::Real;
  spec.defaultValue = defaultValue;
  spec.min = min;
  spec.max = max;
  spec.unit = std::move(unit);
  return spec;
}

ParameterSpec flag(bool defaultValue) {
  ParameterSpec spec;
  spec.type = ParameterSpec::Type::Bool;
  spec.defaultValue = defaultValue;
  return spec;
}

ParameterSpec choice(std::string defaultValue, std::vector<std::string> choices) {
  ParameterSpec spec;
  spec.type = ParameterSpec::Type::Choice;
  spec.defaultValue = std::move(defaultValue);
  spec.choices = std::move(choices);
  return spec;
}

ParameterSpec text(std::string defaultValue) {
  ParameterSpec spec;
  spec.type = ParameterSpec::Type::Text;
  spec.defaultValue = std::move(defaultValue);
  return spec;
}

const std::vector<ParameterSpec>& viewParameters() {
  static const std::vector<ParameterSpec> specs = [] {
    std::vector<ParameterSpec> list;
    const auto add = [&](const char* name, ParameterSpec spec, const char* doc) {
      spec.name = name;
      spec.doc = doc;
      list.push_back(std::move(spec));
    };
    add("materials", choice("diffuse", {"diffuse", "full"}),
        "what surfaces are: `diffuse` takes all for Lambertian and metals for black, `full` is everything "
        "that "
        "glTF says of them; if not given, what the scene says");
    add("fovea_radius", real(0.25, 0.001, 4, "image widths"), "radius of the fovea around the gaze");
    add("fovea_degrees", real(0, 0, 60, "degrees"),
        "radius of the fovea as an angle from the line of sight, by the field of view of each view; above 0 "
        "it takes the place of `fovea_radius`");
    add("pixels_per_degree", real(0, 0, 1000),
        "pixels of the picture in a degree of what the eye sees, by which passes know what it resolves; 0 "
        "means that the picture is seen from where its perspective is right");
    add("jitter", integer(0, 0, 64),
        "places in its pixels through which each view looks in turn, one a frame, so that a mean over frames "
        "has smooth edges; 0: the centres");
    return list;
  }();
  return specs;
}

namespace {

[[noreturn]] void wrongParameter(std::string_view name, std::string_view wanted, bool known) {
  throw Error(ExitCode::Internal, known ? fmt::format("parameter `{}` is not declared as {}", name, wanted)
                                        : fmt::format("parameter `{}` is not declared", name));
}

}  // namespace

const ParameterSpec* findParameter(const std::vector<ParameterSpec>& own, std::string_view name) {
  const bool ofView = name.starts_with(kViewPrefix);
  if (ofView) name.remove_prefix(kViewPrefix.size());
  for (const ParameterSpec& spec : ofView ? viewParameters() : own)
    if (spec.name == name) return &spec;
  return nullptr;
}

const ParameterSpec* Parameters::findSpec(std::string_view name) const {
  return specs_ ? findParameter(*specs_, name) : nullptr;
}

const Value* Parameters::find(std::string_view name) const {
  const ParameterSpec* spec = findSpec(name);
  if (!spec) return nullptr;
  return name.starts_with(kViewPrefix) ? &(*all_)[static_cast<size_t>(spec - viewParameters().data())]
                                       : &(*all_)[first_ + static_cast<size_t>(spec - specs_->data())];
}

int64_t Parameters::integer(std::string_view name) const {
  const Value* value = find(name);
  if (!value || !std::holds_alternative<int64_t>(*value)) wrongParameter(name, "a whole number", value);
  return std::get<int64_t>(*value);
}

double Parameters::real(std::string_view name) const {
  const Value* value = find(name);
  if (value && std::holds_alternative<int64_t>(*value)) return static_cast<double>(std::get<int64_t>(*value));
  if (!value || !std::holds_alternative<double>(*value)) wrongParameter(name, "a number", value);
  return std::get<double>(*value);
}

bool Parameters::flag(std::string_view name) const {
  const Value* value = find(name);
  if (!value || !std::holds_alternative<bool>(*value)) wrongParameter(name, "a flag", value);
  return std::get<bool>(*value);
}

const std::string& Parameters::text(std::string_view name) const {
  const Value* value = find(name);
  if (!value || !std::holds_alternative<std::string>(*value)) wrongParameter(name, "a text", value);
  return std::get<std::string>(*value);
}

// ---- Resources ---------------------------------------------------------------------------------------

ResourceSpec image2D(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr mips) {
  ResourceSpec spec;
  spec.format = format;
  spec.width = std::move(width);
  spec.height = std::move(height);
  spec.mips = std::move(mips);
  return spec;
}

ResourceSpec image2D(VkFormat format) { return image2D(format, viewWidth(), viewHeight()); }

ResourceSpec ofLight(ResourceSpec image, uint32_t power) {
  image.light = power;
  return image;
}

ResourceSpec image2DArray(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr layers) {
  ResourceSpec spec = image2D(format, std::move(width), std::move(height));
  spec.array = true;
  spec.layers = std::move(layers);
  return spec;
}

ResourceSpec image3D(VkFormat format, SizeExpr width, SizeExpr height, SizeExpr depth, SizeExpr mips) {
  ResourceSpec spec = image2D(format, std::move(width), std::move(height), std::move(mips));
  spec.volume = true;
  spec.depth = std::move(depth);
  return spec;
}

ResourceSpec buffer(std::string element, uint32_t stride, SizeExpr count) {
  ResourceSpec spec;
  spec.kind = ResourceKind::Buffer;
  spec.element = std::move(element);
  spec.stride = stride;
  spec.count = std::move(count);
  return spec;
}

// ---- Passes ------------------------------------------------------------------------------------------

namespace {

PortSpec& addPort(PassDeclaration& d, Direction direction, std::string name, std::string bundle,
                  std::vector<MemberSpec> members, std::string doc) {
  PortSpec port;
  port.name = std::move(name);
  port.doc = std::move(doc);
  port.direction = direction;
  port.bundle = std::move(bundle);
  port.members = std::move(members);
  return d.ports.emplace_back(std::move(port));
}

std::vector<MemberSpec> plain(ResourceSpec resource, Usage usage) {
  std::vector<MemberSpec> members(1);
  members[0].resource = std::move(resource);
  members[0].usage = usage;
  return members;
}

}  // namespace

PortSpec& PassDeclaration::input(std::string name, ResourceSpec resource, Usage usage, std::string doc) {
  return addPort(*this, Direction::Input, std::move(name), {}, plain(std::move(resource), usage),
                 std::move(doc));
}

PortSpec& PassDeclaration::output(std::string name, ResourceSpec resource, Usage usage, std::string doc) {
  return addPort(*this, Direction::Output, std::move(name), {}, plain(std::move(resource), usage),
                 std::move(doc));
}

PortSpec& PassDeclaration::inout(std::string name, ResourceSpec resource, Usage usage, std::string doc) {
  return addPort(*this, Direction::InOut, std::move(name), {}, plain(std::move(resource), usage),
                 std::move(doc));
}

PortSpec& PassDeclaration::scratch(std::string name, ResourceSpec resource, Usage usage, std::string doc) {
  return addPort(*this, Direction::Scratch, std::move(name), {}, plain(std::move(resource), usage),
                 std::move(doc));
}

PortSpec& PassDeclaration::input(std::string name, std::string bundle, std::vector<MemberSpec> members,
                                 std::string doc) {
  return addPort(*this, Direction::Input, std::move(name), std::move(bundle), std::move(members),
                 std::move(doc));
}

PortSpec& PassDeclaration::output(std::string name, std::string bundle, std::vector<MemberSpec> members,
                                  std::string doc) {
  return addPort(*this, Direction::Output, std::move(name), std::move(bundle), std::move(members),
                 std::move(doc));
}

PortSpec& PassDeclaration::inout(std::string name, std::string bundle, std::vector<MemberSpec> members,
                                 std::string doc) {
  return addPort(*this, Direction::InOut, std::move(name), std::move(bundle), std::move(members),
                 std::move(doc));
}

PassDeclaration& PassDeclaration::parameter(std::string name, ParameterSpec spec, std::string doc) {
  spec.name = std::move(name);
  spec.doc = std::move(doc);
  parameters.push_back(std::move(spec));
  return *this;
}

PassDeclaration& PassDeclaration::counter(std::string name, std::string doc) {
  counters.push_back({std::move(name), std::move(doc)});
  return *this;
}

PassDeclaration& PassDeclaration::require(SizeExpr condition, std::string message, std::string remedy) {
  requirements.push_back({std::move(condition), std::move(message), std::move(remedy)});
  return *this;
}

// ---- Steps -------------------------------------------------------------------------------------------

StepSpec& StepSpec::called(std::string stepName) {
  name = std::move(stepName);
  return *this;
}

StepSpec& StepSpec::when(SizeExpr isTrue) {
  condition = std::move(isTrue);
  return *this;
}

StepSpec& StepSpec::runTogether() {
  together = true;
  return *this;
}

StepSpec& StepSpec::define(std::string macro, SizeExpr value) {
  defines.emplace_back(std::move(macro), std::move(value));
  return *this;
}

StepSpec& StepSpec::constant(std::string constant, SizeExpr value) {
  constants.emplace_back(std::move(constant), std::move(value));
  return *this;
}

StepSpec& StepSpec::groups(SizeExpr x, SizeExpr y, SizeExpr z) {
  sizing = Size::Groups;
  size[0] = std::move(x), size[1] = std::move(y), size[2] = std::move(z);
  return *this;
}

StepSpec& StepSpec::threads(SizeExpr x, SizeExpr y, SizeExpr z) {
  groups(std::move(x), std::move(y), std::move(z));
  sizing = Size::Threads;
  return *this;
}

StepSpec& StepSpec::over(std::string port) {
  sizing = Size::Over;
  sizePort = std::move(port);
  return *this;
}

StepSpec& StepSpec::indirect(std::string buffer, uint64_t byteOffset) {
  sizing = Size::Indirect;
  sizePort = std::move(buffer);
  offset = byteOffset;
  return *this;
}

StepSpec& StepSpec::tiles(std::string mask) {
  tileMask = std::move(mask);
  return *this;
}

namespace {

// "blur/rows.comp" -> "rows"
std::string stemOf(const std::string& shader) {
  const size_t slash = shader.rfind('/'), begin = slash == std::string::npos ? 0 : slash + 1;
  return shader.substr(begin, shader.rfind('.') - begin);
}

StepSpec& addStep(PassDeclaration& d, StepSpec::Action action, std::string name) {
  StepSpec step;
  step.action = action;
  step.name = std::move(name);
  return d.steps.emplace_back(std::move(step));
}

}  // namespace

StepSpec& PassDeclaration::step(std::string computeShader) {
  StepSpec& step = addStep(*this, StepSpec::Action::Dispatch, stemOf(computeShader));
  step.shader = std::move(computeShader);
  return step;
}

StepSpec& PassDeclaration::fullscreen(std::string fragmentShader, std::vector<std::string> images) {
  StepSpec& step = addStep(*this, StepSpec::Action::Fullscreen, stemOf(fragmentShader));
  step.shader = std::move(fragmentShader);
  step.targets = std::move(images);
  return step;
}

StepSpec& PassDeclaration::fill(std::string buffer, uint32_t word) {
  StepSpec& step = addStep(*this, StepSpec::Action::Fill, "fill " + buffer);
  step.targets = {std::move(buffer)};
  step.word = word;
  return step;
}

StepSpec& PassDeclaration::clear(std::string image, uint32_t word) {
  StepSpec& step = addStep(*this, StepSpec::Action::Clear, "clear " + image);
  step.targets = {std::move(image)};
  step.word = word;
  return step;
}

StepSpec& PassDeclaration::copy(std::string imageFrom, std::string imageTo) {
  StepSpec& step = addStep(*this, StepSpec::Action::Copy, "copy " + imageFrom);
  step.source = std::move(imageFrom);
  step.targets = {std::move(imageTo)};
  return step;
}

SourceLocation PassDeclaration::placeOf(const std::string& path) const {
  if (!places) return {};
  auto found = places->find(path);
  if (found == places->end()) found = places->find("");
  return found == places->end() ? SourceLocation() : found->second;
}

const PortSpec* PassDeclaration::findPort(std::string_view name) const {
  for (const PortSpec& port : ports)
    if (port.name == name) return &port;
  return nullptr;
}

MemberSpec member(std::string name, ResourceSpec resource, Usage usage, std::string doc) {
  return {std::move(name), std::move(doc), std::move(resource), usage};
}

std::string memberPath(const PortSpec& port, const MemberSpec& member) {
  return member.name.empty() ? port.name : port.name + "." + member.name;
}

std::string shaderName(std::string_view path) {
  std::string name;
  bool upper = false;
  for (const char c : path) {
    if (c == '_' || c == '.' || c == '-' || c == '/') {
      upper = !name.empty();
      continue;
    }
    name += upper && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    upper = false;
  }
  return name;
}

}  // namespace fovea::graph
