// A graph over a scene on a device, ready to render frame after frame: what the program, the benchmarks, the test kit and
// the facade share.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "framework/gpu/device.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/run/execute.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/frame.h"

namespace fovea::session {

// Looks for shaders where the data files lie. `name`: number or part of the name, "" for the best one.
std::unique_ptr<gpu::Device> openDevice(const std::string& name, bool validation = false);

// What a graph is bound to: the views of every frame, the device's limits (nullptr: unknown) and the scene's quantities.
graph::Environment sceneEnvironment(const gpu::Device* device, const scene::Scene& scene,
                                    const scene::Geometry& geometry, glm::uvec2 size);

// The value of a parameter as the graph's passes have it; the last pass that has it decides.
double parameterOr(const graph::BoundGraph& graph, const char* name, double otherwise);

// Texels of a colour or depth format as floats, one channel each. Throws Error(Internal) for integer formats.
image::Image toImage(const graph::OutputData& output);

class GraphRun {
 public:
  struct Options {
    glm::uvec2 size{0};
    uint32_t seed = 1;
    double frameRate = 42;
    // Names of the graph outputs to read back.
    std::function<std::vector<std::string>(const graph::BoundGraph&)> readback;
    graph::HostProgress hostProgress;
    uint32_t framesInFlight =
        0;  // 0: one on a CPU device, where two would only take each other's cores; else two
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

}  // namespace fovea::session
