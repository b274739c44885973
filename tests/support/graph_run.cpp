#include "tests/support/graph_run.h"

#include "framework/base/paths.h"
#include "framework/gpu/format.h"
#include "framework/scene/scene.h"
#include "framework/session/graph_run.h"
#include "framework/session/test_device.h"

namespace fovea::test {

std::vector<float> toFloats(const graph::OutputData& data) {
  return gpu::texelsToFloats(data.desc.format, data.bytes);
}

GraphRun runGraph(const std::string& nameOrPath, const scene::Scene& scene, const GraphRunOptions& options) {
  Diagnostics messages;
  graph::LoadOptions load;
  for (const std::string& text : options.set) load.overrides.push_back(graph::parseOverride(text));
  load.searchPaths = dataFolders("graphs");
  scene::Geometry rest = scene::flatten(scene);
  session::GraphRun::Options runOptions;
  runOptions.size = options.size;
  runOptions.seed = options.seed;
  runOptions.framesInFlight = 2;
  runOptions.rays = options.rays;
  runOptions.countOperations = options.countOperations;
  runOptions.readback = [&](const graph::BoundGraph& bound) {
    std::vector<std::string> names = options.outputs;
    if (names.empty())
      for (const graph::BoundOutput& output : bound.outputs) names.push_back(output.name);
    return names;
  };
  session::GraphRun graph(options.device ? *options.device : testDevice(),
                          graph::load(nameOrPath, load, messages), scene, rest, runOptions, messages);
  graph.prepare();
  GraphRun run;
  const auto collect = [&] {
    while (auto result = graph.executor().next()) {
      if (!result->outputs.empty()) run.outputs = result->outputs;
      run.frames.push_back(std::move(*result));
    }
  };
  for (uint32_t i = 0; i < options.frames; ++i) {
    scene::Frame frame = graph.frame(i);
    if (options.beforeFrame) options.beforeFrame(frame);
    graph.submit(frame, options.everyFrame || i + 1 == options.frames);
    if (options.everyFrame) collect();
  }
  collect();
  return run;
}

}  // namespace fovea::test
