// Runs a whole graph (a file or a bare name) over a scene, for tests of pipelines.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fovea/test.h"
#include "framework/session/graph_run.h"

namespace fovea::test {

struct GraphRun {
  std::map<std::string, graph::OutputData> outputs;  // of the last frame
  std::vector<graph::FrameResult> frames;
};
struct GraphRunOptions {
  glm::uvec2 size{128, 128};
  uint32_t frames = 1, seed = 1;
  std::vector<std::string> set;      // "vpl_count=100"
  std::vector<std::string> outputs;  // names to read back; if empty, all images
  gpu::Device* device = nullptr;     // instead of testDevice()
  session::RaysOn rays = session::RaysOn::Auto;
  bool countOperations = false;
  bool everyFrame = false;  // read back after every frame: GraphRun::frames[i].outputs
  std::function<void(scene::Frame&)> beforeFrame;
};
GraphRun runGraph(const std::string& nameOrPath, const scene::Scene& scene,
                  const GraphRunOptions& options = {});

std::vector<float> toFloats(const graph::OutputData& data);

}  // namespace fovea::test
