// A graph over a scene on a device, ready to render frame after frame: what `fovea render` and `fovea bench`
// share.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "framework/gpu/device.h"
#include "framework/graph/compile.h"
#include "framework/graph/execute.h"
#include "framework/scene/frame.h"
#include "framework/scene/gpu_scene.h"

namespace fovea::cli {

// Looks for shaders where the data files lie. `name`: number or part of the name, "" for the best one.
std::unique_ptr<gpu::Device> openDevice(const std::string& name, bool validation = false);

// As the graph's passes have it; the last of them decides.
double parameterOr(const graph::BoundGraph& graph, const char* name, double otherwise);

class GraphRun {
 public:
  struct Options {
    glm::uvec2 size{0};
    uint32_t seed = 1;
    double frameRate = 42;
    // Names of the graph outputs to read back.
    std::function<std::vector<std::string>(const graph::BoundGraph&)> readback;
    graph::HostProgress hostProgress;
  };
  // Binds and compiles. Warnings go to `messages`; throws Error(BadInput) with every mistake. Device, scene
  // and geometry must outlive the run, which moves the geometry.
  GraphRun(gpu::Device& device, const graph::Description& description, const scene::Scene& scene,
           scene::Geometry& geometry, Options options, Diagnostics& messages);
  // Allocates memory, uploads the scene, compiles shaders. Throws as graph::Executor does.
  void prepare();

  const std::shared_ptr<const graph::Plan>& plan() const { return plan_; }
  const graph::BoundGraph& graph() const { return *plan_->graph; }
  const std::vector<std::string>& readback() const { return readback_; }
  scene::Frame frame(uint64_t index) const;
  // After prepare(): moves the geometry where a pass reads it, then submits.
  void submit(const scene::Frame& frame, bool readOutputs);
  graph::Executor& executor() { return *executor_; }
  uint32_t inFlight() const { return inFlight_; }

 private:
  gpu::Device& device_;
  const scene::Scene& scene_;
  scene::Geometry& geometry_;
  Options options_;
  std::shared_ptr<const graph::Plan> plan_;
  std::vector<std::string> readback_;
  uint32_t inFlight_ = 2;
  std::unique_ptr<scene::GpuScene> gpuScene_;
  std::unique_ptr<graph::Executor> executor_;
};

}  // namespace fovea::cli
