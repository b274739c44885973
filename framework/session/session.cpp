// Implements the facade fovea/session.h with a device, a scene on it and an executor.
#include "fovea/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>

#include "framework/base/paths.h"
#include "framework/graph/document/document.h"
#include "framework/graph/pass/pass_file.h"
#include "framework/graph/pass/registry.h"
#include "framework/graph/report/report.h"
#include "framework/scene/lights.h"
#include "framework/scene/scene.h"
#include "framework/session/course.h"
#include "framework/session/graph_run.h"
#include "framework/session/sources.h"

namespace fovea::graph {

void loadPlugin(const std::filesystem::path& file) { Registry::global().loadPlugin(file); }

void addPasses(const std::filesystem::path& folder) { Registry::global().addFolder(folder); }

void rereadPasses() { Registry::global().rereadFiles(); }

void addPass(PassDeclaration declaration, std::function<std::unique_ptr<Pass>()> make) {
  Registry::global().addOrReplace(std::move(declaration), std::move(make));
}

PassDeclaration hostPass(const std::string& type, std::string_view json, const std::string& source) {
  Diagnostics messages;
  PassDeclaration declaration = readHostPass(json::parse(json, source), type, messages);
  messages.throwIfErrors();
  return declaration;
}

std::vector<const PassDeclaration*> passTypes() {
  std::vector<const PassDeclaration*> list;
  for (const std::string& type : Registry::global().types()) list.push_back(Registry::global().find(type));
  return list;
}

namespace {

void check(const FrameOptions& frame) {
  // Written so that NaN also fails.
  if (frame.time && !(*frame.time >= 0 && std::isfinite(*frame.time)))
    throw Error(ExitCode::Usage, fmt::format("FrameOptions::time is {} seconds", *frame.time),
                "the time of a scene begins at 0");
  if (frame.gaze && !(glm::all(glm::greaterThanEqual(*frame.gaze, glm::vec2(0))) &&
                      glm::all(glm::lessThanEqual(*frame.gaze, glm::vec2(1)))))
    throw Error(ExitCode::Usage,
                fmt::format("FrameOptions::gaze is {}, {}, outside the image", frame.gaze->x, frame.gaze->y),
                "0, 0 is the top left corner of the image and 0.5, 0.5 its middle");
  if (frame.camera && !(frame.camera->verticalFov > 0 && frame.camera->verticalFov < glm::pi<float>() &&
                        frame.camera->zNear > 0))
    throw Error(
        ExitCode::Usage,
        fmt::format("FrameOptions::camera has a vertical field of view of {} radians and a near plane "
                    "at {} metres",
                    frame.camera->verticalFov, frame.camera->zNear),
        "the former lies between 0 and pi, the latter above 0");
}

bool isPort(const std::string& name) { return name.find(':') != std::string::npos; }

// Later values take the place of earlier ones.
std::vector<std::string> merged(std::vector<std::string> values, const std::vector<std::string>& more) {
  for (const std::string& text : more) {
    const std::string name = parseOverride(text).name;
    std::erase_if(values, [&](const std::string& old) { return parseOverride(old).name == name; });
    values.push_back(text);
  }
  return values;
}

}  // namespace

struct Session::Impl {
  Document graph;
  const scene::Scene& scene;
  SessionOptions options;
  scene::Geometry geometry;
  Diagnostics warnings;
  std::unique_ptr<session::GraphRun> run;
  std::map<std::string, std::vector<std::byte>> inputs;
  session::Course course;
  std::vector<std::string> ports;  // those among the options' `read`

  void use(SessionOptions changed);
  void checkInputs() const;
  scene::Moment momentOf(const FrameOptions& frame);
};

// Makes a run with these options, which takes over from the one before. If it throws, nothing has changed.
void Session::Impl::use(SessionOptions changed) {
  LoadOptions load;
  for (const std::string& text : changed.set) load.overrides.push_back(parseOverride(text));
  load.searchPaths = dataFolders("graphs");
  Registry::global().addFolderBeside(graph.file());
  Diagnostics messages;
  const Description description = resolve(graph, load, messages);
  if (!changed.device) changed.device = gpu::openDevice();
  session::GraphRun::Options how;
  how.size = changed.size;
  how.seed = changed.seed;
  how.frameRate = changed.frameRate;
  how.givesInputs = how.observable = true;
  how.hostProgress = changed.progress;
  how.readback = [read = changed.read](const BoundGraph& bound) {
    std::vector<std::string> names;
    for (const BoundOutput& output : bound.outputs)
      if (read.empty() || std::find(read.begin(), read.end(), output.name) != read.end())
        names.push_back(output.name);
    return names;
  };
  auto next =
      std::make_unique<session::GraphRun>(*changed.device, description, scene, geometry, how, messages);
  std::vector<Observation> observations;
  std::vector<std::string> wanted;
  for (const std::string& name : changed.read) {
    Observation found = session::findSource(*next->plan(), name);
    if (!isPort(name)) continue;  // an output, read back as a whole
    observations.push_back(std::move(found));
    wanted.push_back(name);
  }
  next->prepare(run.get());
  run = std::move(next);
  options = std::move(changed);
  ports = std::move(wanted);
  warnings = std::move(messages);
  run->executor().observe(std::move(observations));
  for (const auto& [name, bytes] : inputs) run->executor().setInput(name, bytes, scene::preExposure(scene));
}

void Session::Impl::checkInputs() const {
  const Plan& plan = *run->plan();
  for (size_t i = 0; i < plan.graph->resources.size(); ++i) {
    const BoundResource& resource = plan.graph->resources[i];
    if (resource.external && plan.resourceLive[i] && !inputs.contains(resource.name))
      throw Error(ExitCode::Usage,
                  fmt::format("input `{}` of graph `{}` was never set", resource.name, plan.graph->name),
                  "fill it with Session::setInput() before the first frame");
  }
}

scene::Moment Session::Impl::momentOf(const FrameOptions& frame) {
  const bool untouched = !frame.time && !frame.camera && !frame.gaze && !frame.cut;
  if (untouched && !course.begun()) {
    course.follow(scene::momentAt(scene, frame.index, options.frameRate));
    return course.shown();
  }
  return course.next(scene, frame.index,
                     {.time = frame.time.value_or(double(frame.index) / options.frameRate),
                      .camera = frame.camera,
                      .gaze = frame.gaze,
                      .cut = frame.cut || frame.index == 0});
}

Session::Session(const Document& graph, const scene::Scene& scene, const SessionOptions& options)
    : impl_(std::make_unique<Impl>(Impl{.graph = graph, .scene = scene, .geometry = scene::flatten(scene)})) {
  if (options.size.x == 0 || options.size.y == 0)
    throw Error(ExitCode::Usage,
                fmt::format("SessionOptions::size is {}x{} pixels", options.size.x, options.size.y),
                "a picture has at least one pixel");
  if (!(options.frameRate > 0))
    throw Error(ExitCode::Usage, fmt::format("SessionOptions::frameRate is {}", options.frameRate),
                "there is at least part of a frame in a second: give a number above 0");
  Registry::global().addFoldersFromEnvironment();
  impl_->use(options);
}

Session::~Session() = default;

FrameResult Session::render(const FrameOptions& frame) {
  check(frame);
  impl_->checkInputs();
  session::GraphRun& run = *impl_->run;
  run.submit(run.frame(impl_->momentOf(frame)), frame.read, frame.read && !impl_->ports.empty());
  return *run.executor().next();
}

void Session::set(const std::vector<std::string>& values) {
  SessionOptions changed = impl_->options;
  changed.set = merged(std::move(changed.set), values);
  impl_->use(std::move(changed));
}

void Session::read(const std::vector<std::string>& names) {
  SessionOptions changed = impl_->options;
  changed.read = names;
  impl_->use(std::move(changed));
}

void Session::setInput(const std::string& name, std::span<const std::byte> bytes) {
  impl_->run->executor().setInput(name, bytes, scene::preExposure(impl_->scene));
  impl_->inputs[name].assign(bytes.begin(), bytes.end());
}

image::Image Session::picture(const FrameResult& frame, const std::string& name) const {
  const auto it = frame.outputs.find(name);
  if (it == frame.outputs.end())
    throw Error(ExitCode::Usage, "`" + name + "` was not read back", "name it in Session::read()");
  return session::toImage(it->second);
}

std::vector<RecordField> Session::fields(const std::string& element) const {
  const ElementTypes types = impl_->run->executor().elementTypes();
  const auto found = types.find(element);
  return found != types.end() ? found->second : std::vector<RecordField>();
}

std::map<std::string, ResourceDesc> Session::inputs() const {
  std::map<std::string, ResourceDesc> inputs;
  for (const BoundResource& resource : impl_->run->graph().resources)
    if (resource.external) inputs.emplace(resource.name, resource.desc);
  return inputs;
}

std::vector<std::string> Session::outputs() const {
  std::vector<std::string> names;
  for (const BoundOutput& output : impl_->run->graph().outputs) names.push_back(output.name);
  return names;
}

std::string Session::plan(PlanForm form) const { return writePlan(*impl_->run->plan(), form); }

const std::string& Session::passName(uint32_t pass) const { return impl_->run->graph().passes.at(pass).name; }

const std::shared_ptr<gpu::Device>& Session::device() const { return impl_->options.device; }

const Diagnostics& Session::warnings() const { return impl_->warnings; }

}  // namespace fovea::graph
