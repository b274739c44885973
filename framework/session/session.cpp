// Implements the facade fovea/graph.h with a device, a scene on it and an executor.
#include <algorithm>

#include "fovea/graph.h"
#include "framework/base/paths.h"
#include "framework/graph/pass/registry.h"
#include "framework/session/graph_run.h"

namespace fovea::graph {

void loadPlugin(const std::filesystem::path& file) { Registry::global().loadPlugin(file); }

void addPasses(const std::filesystem::path& folder) { Registry::global().addFolder(folder); }

struct Session::Impl {
  std::unique_ptr<gpu::Device> device;
  scene::Geometry geometry;
  Diagnostics warnings;
  std::unique_ptr<session::GraphRun> run;
};

Session::Session(const std::string& graph, const scene::Scene& scene, const SessionOptions& options)
    : impl_(std::make_unique<Impl>()) {
  LoadOptions load;
  for (const std::string& text : options.set) load.overrides.push_back(parseOverride(text));
  load.searchPaths = dataFolders("graphs");
  Registry::global().addFoldersFromEnvironment();
  Registry::global().addFolderBeside(findGraph(graph, load.searchPaths));
  const Description description = graph::load(graph, load, impl_->warnings);
  impl_->device =
      session::openDevice({.device = options.device,
                           .without = options.without,
                           .validation = options.validation ? gpu::Validation::On : gpu::Validation::Off});
  impl_->geometry = scene::flatten(scene);
  session::GraphRun::Options run;
  run.size = options.size;
  run.seed = options.seed;
  run.frameRate = options.frameRate;
  run.readback = [&](const BoundGraph& bound) {
    std::vector<std::string> names = options.outputs;
    if (names.empty())
      for (const BoundOutput& output : bound.outputs) names.push_back(output.name);
    return names;
  };
  impl_->run = std::make_unique<session::GraphRun>(*impl_->device, description, scene, impl_->geometry, run,
                                                   impl_->warnings);
  impl_->run->prepare();
}

Session::~Session() = default;

FrameResult Session::render(uint64_t index) {
  impl_->run->submit(impl_->run->frame(index), true);
  return *impl_->run->executor().next();
}

image::Image Session::picture(const FrameResult& frame, const std::string& output) const {
  const auto it = frame.outputs.find(output);
  if (it == frame.outputs.end())
    throw Error(ExitCode::Usage, "output `" + output + "` was not read back",
                "name it in SessionOptions::outputs, or leave these empty");
  return session::toImage(it->second);
}

const std::string& Session::passName(uint32_t pass) const { return impl_->run->graph().passes.at(pass).name; }

const Diagnostics& Session::warnings() const { return impl_->warnings; }

}  // namespace fovea::graph
