#include "fovea/test.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/packing.hpp>
#include <span>
#include <stdexcept>

#include "framework/gpu/device.h"
#include "framework/gpu/format.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/migrate/migrate.h"
#include "framework/graph/pass/registry.h"
#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "framework/session/graph_run.h"
#include "framework/session/test_device.h"

namespace fovea::test {
namespace {

constexpr uint32_t kFramesInFlight = 2;

struct InputData {
  graph::ResourceDesc desc;
  std::string element;
  std::vector<std::byte> raw;
  bool changed = true;
};

std::string quoted(const std::string& s) { return '"' + s + '"'; }

std::string numberText(double value) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

std::string describe(const InputData& input) {
  const graph::ResourceDesc& d = input.desc;
  if (d.kind == graph::ResourceKind::Buffer)
    return "{\"element\": " + quoted(input.element) + ", \"stride\": " + std::to_string(d.stride) +
           ", \"count\": " + std::to_string(d.count) + "}";
  std::string text = "{\"format\": " + quoted(std::string(gpu::formatInfo(d.format).name)) +
                     ", \"width\": " + std::to_string(d.width) + ", \"height\": " + std::to_string(d.height);
  if (d.volume) text += ", \"depth\": " + std::to_string(d.depth);
  if (d.array) text += ", \"layers\": " + std::to_string(d.layers);
  if (d.mips > 1) text += ", \"mips\": " + std::to_string(d.mips);
  return text + "}";
}

// Whether the device has a wider format in the place of one that a test or a declaration names (replaceFormats()).
bool replaced(VkFormat format) {
  return format == VK_FORMAT_R16G16_SNORM && testDevice().lacks("VK_FORMAT_R16G16_SNORM");
}

std::vector<std::byte> toReplaced(VkFormat format, const std::vector<std::byte>& texels) {
  const std::vector<float> values = gpu::texelsToFloats(format, texels);
  const auto bytes = std::as_bytes(std::span(values));
  return {bytes.begin(), bytes.end()};
}

void fromReplaced(VkFormat format, graph::OutputData& output) {
  const std::vector<float> values = gpu::texelsToFloats(output.desc.format, output.bytes);
  std::vector<int16_t> texels(values.size());
  for (size_t i = 0; i < values.size(); ++i)
    texels[i] = int16_t(std::lround(std::clamp(values[i], -1.0f, 1.0f) * 32767.0f));
  const auto bytes = std::as_bytes(std::span(texels));
  output.bytes.assign(bytes.begin(), bytes.end());
  output.desc.format = format;
}

// Light is read back as 32-bit floats; tests see the texels as the pass stores them, to the bit.
void toStoredLight(VkFormat format, graph::OutputData& output) {
  output.bytes = gpu::floatsToTexels(format, gpu::texelsToFloats(output.desc.format, output.bytes));
  output.desc.format = format;
}

scene::Scene defaultScene() {
  scene::Scene s;
  s.name = "empty";
  s.materials.emplace_back();
  scene::Camera camera;
  camera.position = {0, 0, 5};
  s.cameras.push_back(camera);
  return s;
}

}  // namespace

struct PassTest::Impl {
  std::string type;
  const graph::PassDeclaration* declaration = nullptr;
  std::map<std::string, std::string> params;  // values as JSON
  std::map<std::string, std::string> view = {{"materials", "\"diffuse\""}};
  glm::uvec2 size{64, 64};
  uint32_t seed = 1;
  session::RaysOn rays = session::RaysOn::Auto;
  std::map<std::string, InputData> inputs;
  std::function<void(PassTest&, scene::Frame&)> hook;
  scene::Scene scene;
  scene::Geometry geometry;  // at the time of the frame, for the tests
  scene::Geometry rest;      // as uploaded to the device, at rest
  std::unique_ptr<session::GraphRun> graph;
  uint64_t frameIndex = 0;
  graph::FrameResult result;
  scene::Frame lastFrame;

  std::string graphText() const;
  void build();
};

std::string PassTest::Impl::graphText() const {
  std::string inputText, wires, outputs, paramText, viewText;
  auto append = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; };
  for (const graph::PortSpec& port : declaration->ports) {
    if (port.direction == graph::Direction::Input || port.direction == graph::Direction::InOut) {
      std::string members;
      bool plain = false;
      for (const graph::MemberSpec& m : port.members) {
        const auto it = inputs.find(graph::memberPath(port, m));
        if (it == inputs.end()) continue;
        plain = m.name.empty();
        append(members, plain ? describe(it->second) : quoted(m.name) + ": " + describe(it->second));
      }
      if (members.empty()) continue;
      append(inputText,
             quoted(port.name) + ": " +
                 (plain ? members
                        : "{\"bundle\": " + quoted(port.bundle) + ", \"members\": {" + members + "}}"));
      append(wires, quoted(port.name) + ": " + quoted("inputs." + port.name));
    }
    if (port.direction == graph::Direction::Output || port.direction == graph::Direction::InOut)
      append(outputs, quoted(port.name) + ": " + quoted("test." + port.name));
  }
  for (const auto& [name, value] : params) append(paramText, quoted(name) + ": " + value);
  for (const auto& [name, value] : view) append(viewText, quoted(name) + ": " + value);
  return "{\"version\": " + std::to_string(graph::kGraphVersion) + ", \"view\": {" + viewText +
         "}, \"inputs\": {" + inputText + "}, \"passes\": {\"test\": {\"type\": " + quoted(type) +
         ", \"inputs\": {" + wires + "}, \"params\": {" + paramText + "}}}, \"outputs\": {" + outputs + "}}";
}

void PassTest::Impl::build() {
  Diagnostics messages;
  const graph::Description description = graph::loadText(graphText(), "pass-test.json", {}, messages);
  scene.preExposure = 1;  // inputs are given as passes store them
  geometry = rest = scene::flatten(scene);
  session::GraphRun::Options options;
  options.size = size;
  options.seed = seed;
  options.rays = rays;
  options.framesInFlight = kFramesInFlight;
  options.givesInputs = true;
  options.readback = [](const graph::BoundGraph& bound) {
    std::vector<std::string> names;
    for (const graph::BoundOutput& output : bound.outputs) names.push_back(output.name);
    return names;
  };
  graph = std::make_unique<session::GraphRun>(testDevice(), description, scene, rest, options, messages);
  graph->prepare();
}

PassTest::PassTest(std::string type) : impl_(std::make_unique<Impl>()) {
  impl_->declaration = graph::Registry::global().find(type);
  if (!impl_->declaration) throw std::invalid_argument("no pass type " + type);
  impl_->type = std::move(type);
  impl_->scene = defaultScene();
}
PassTest::~PassTest() = default;

PassTest& PassTest::param(const std::string& name, bool value) {
  impl_->params[name] = value ? "true" : "false";
  return *this;
}
PassTest& PassTest::param(const std::string& name, int value) {
  impl_->params[name] = std::to_string(value);
  return *this;
}
PassTest& PassTest::param(const std::string& name, double value) {
  impl_->params[name] = numberText(value);
  return *this;
}
PassTest& PassTest::param(const std::string& name, const char* value) {
  impl_->params[name] = quoted(value);
  return *this;
}
PassTest& PassTest::view(const std::string& name, int value) {
  impl_->view[name] = std::to_string(value);
  return *this;
}
PassTest& PassTest::view(const std::string& name, double value) {
  impl_->view[name] = numberText(value);
  return *this;
}
PassTest& PassTest::view(const std::string& name, const char* value) {
  impl_->view[name] = quoted(value);
  return *this;
}
PassTest& PassTest::viewSize(uint32_t width, uint32_t height) {
  impl_->size = {width, height};
  return *this;
}
PassTest& PassTest::scene(scene::Scene scene) {
  impl_->scene = std::move(scene);
  if (impl_->scene.cameras.empty()) impl_->scene.cameras = defaultScene().cameras;
  if (impl_->scene.materials.empty()) impl_->scene.materials.emplace_back();
  return *this;
}
PassTest& PassTest::seed(uint32_t seed) {
  impl_->seed = seed;
  return *this;
}
PassTest& PassTest::raysOnHost(bool onHost) {
  impl_->rays = onHost ? session::RaysOn::Host : session::RaysOn::Device;
  return *this;
}
PassTest& PassTest::beforeFrame(std::function<void(PassTest&, scene::Frame&)> hook) {
  impl_->hook = std::move(hook);
  return *this;
}

PassTest& PassTest::imageBytes(const std::string& port, VkFormat format, uint32_t width, uint32_t height,
                               uint32_t layers, bool volume, std::vector<std::byte> raw, uint32_t mips) {
  InputData input;
  input.desc.kind = graph::ResourceKind::Image;
  input.desc.format = format;
  input.desc.width = width;
  input.desc.height = height;
  input.desc.volume = volume;
  (volume ? input.desc.depth : input.desc.layers) = layers;
  // The image is an array if the pass declares one or if there is more than one layer.
  input.desc.array = !volume && layers > 1;
  for (const auto& p : impl_->declaration->ports)
    for (const auto& m : p.members)
      if (graph::memberPath(p, m) == port) input.desc.array |= m.resource.array;
  input.desc.mips = mips;
  uint64_t expected = 0;
  for (uint32_t mip = 0; mip < mips; ++mip)
    expected += uint64_t(std::max(1u, width >> mip)) * std::max(1u, height >> mip) *
                (volume ? std::max(1u, layers >> mip) : layers) * gpu::formatInfo(format).bytesPerTexel;
  if (raw.size() != expected)
    throw std::invalid_argument("input " + port + ": " + std::to_string(raw.size()) + " bytes given, " +
                                std::to_string(expected) + " expected");
  input.raw = std::move(raw);
  impl_->inputs[port] = std::move(input);
  return *this;
}

PassTest& PassTest::bufferBytes(const std::string& port, const std::string& element, uint32_t stride,
                                uint64_t count, std::vector<std::byte> raw) {
  InputData input;
  input.desc.kind = graph::ResourceKind::Buffer;
  input.desc.stride = stride;
  input.desc.count = count;
  input.element = element;
  input.raw = std::move(raw);
  impl_->inputs[port] = std::move(input);
  return *this;
}

void PassTest::setBytes(const std::string& port, std::vector<std::byte> raw) {
  InputData& input = impl_->inputs.at(port);
  if (raw.size() != input.raw.size()) throw std::invalid_argument("input " + port + " changes its size");
  input.raw = std::move(raw);
  input.changed = true;
}

void PassTest::run(uint32_t frames) {
  if (!impl_->graph) impl_->build();
  graph::Executor& executor = impl_->graph->executor();
  for (uint32_t i = 0; i < frames; ++i) {
    scene::Frame frame = impl_->graph->frame(impl_->frameIndex++);
    if (impl_->hook) impl_->hook(*this, frame);
    scene::moveObjects(frame, impl_->geometry);
    for (auto& [name, input] : impl_->inputs) {
      if (input.changed && replaced(input.desc.format))
        executor.setInput(name, toReplaced(input.desc.format, input.raw));
      else if (input.changed)
        executor.setInput(name, input.raw);
      input.changed = false;
    }
    impl_->graph->submit(frame, i + 1 == frames);
    impl_->lastFrame = frame;
  }
  while (auto result = executor.next()) impl_->result = std::move(*result);
  for (const graph::PortSpec& port : impl_->declaration->ports)
    for (const graph::MemberSpec& m : port.members) {
      const auto output = impl_->result.outputs.find(graph::memberPath(port, m));
      if (output == impl_->result.outputs.end()) continue;
      if (replaced(m.resource.format)) fromReplaced(m.resource.format, output->second);
      if (m.resource.light > 0 && port.direction == graph::Direction::Output)
        toStoredLight(m.resource.format, output->second);
    }
  const std::vector<std::string> messages = takeValidationMessages();
  if (!messages.empty())
    throw std::runtime_error("the validation layers object " + std::to_string(messages.size()) +
                             " times, first: " + messages.front());
}

static const graph::OutputData& outputOf(const graph::FrameResult& result, const std::string& port) {
  const auto it = result.outputs.find(port);
  if (it == result.outputs.end()) throw std::invalid_argument("no output " + port + " was read back");
  return it->second;
}

const std::vector<std::byte>& PassTest::bytes(const std::string& port) const {
  return outputOf(impl_->result, port).bytes;
}
const graph::ResourceDesc& PassTest::desc(const std::string& port) const {
  return outputOf(impl_->result, port).desc;
}
std::vector<float> PassTest::floats(const std::string& port) const {
  const graph::OutputData& output = outputOf(impl_->result, port);
  return gpu::texelsToFloats(output.desc.format, output.bytes);
}

double PassTest::counter(const std::string& name) const {
  for (const auto& [n, value] : impl_->result.counters)
    if (n == "test." + name) return value;
  throw std::invalid_argument("no counter " + name);
}
const graph::PassDeclaration& PassTest::declaration() const { return *impl_->declaration; }
double PassTest::gpuMs() const { return impl_->result.passes.at(0).gpuMs; }
const scene::Frame& PassTest::lastFrame() const { return impl_->lastFrame; }
const scene::Geometry& PassTest::geometry() const { return impl_->geometry; }

}  // namespace fovea::test
