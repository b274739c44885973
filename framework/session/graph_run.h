// A graph over a scene on a device, ready to render frame after frame. The program, the benchmarks, the test kit and
// the facade share it.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/image.h"
#include "framework/gpu/device.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/run/execute.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/frame.h"

namespace fovea::session {

// Where passes trace rays, with the same results but for rounding.
enum class RaysOn {
  Auto,    // on the host if the device is a CPU, which traces rays much faster by itself
  Host,    // with Embree, or the project's own tracer in portable bundles
  Device,  // in compute shaders
};
// device: nullptr stands for a CPU.
bool raysOnHost(RaysOn rays, const gpu::Device* device);

// The environment to which a graph is bound: the views of every frame, the device's limits (unknown if `device` is
// nullptr) and the scene's quantities and texts.
graph::Environment sceneEnvironment(const gpu::Device* device, const scene::Scene& scene,
                                    const scene::Geometry& geometry, glm::uvec2 size,
                                    RaysOn rays = RaysOn::Auto, const std::optional<glm::uvec2>& inset = {});

// The value of a parameter such as tonemap's `exposure`, or `otherwise` if no pass of the graph has it. If several passes
// have it, the last one decides.
double parameterOr(const graph::BoundGraph& graph, const char* name, double otherwise);

// Texels of a colour or depth format as an image of floats. Throws Error(Internal) for integer formats.
image::Image toImage(const graph::OutputData& output);

class GraphRun {
 public:
  struct Options {
    glm::uvec2 size{0};
    std::optional<glm::uvec2> inset{};  // of insets in the pictures of eyes; not set: `size`
    uint32_t seed = 1;
    double frameRate = 42;
    // Chooses the graph outputs to read back.
    std::function<std::vector<std::string>(const graph::BoundGraph&)> readback;
    graph::HostProgress hostProgress;
    // 0 selects one on a CPU device, where two would only compete for the same cores, and two otherwise.
    uint32_t framesInFlight = 0;
    // Whether the caller fills the inputs that the graph itself has, with Executor::setInput. If not, a graph that has
    // any is refused.
    bool givesInputs = false;
    // Whether what passes make can be read back in the middle of a frame (graph::Executor::observe).
    bool observable = false;
    RaysOn rays = RaysOn::Auto;
    bool countOperations = false;  // graph::ExecutorOptions::countOperations
  };
  // Binds and compiles. Warnings are added to `messages`; throws Error(BadInput) with every mistake. Device, scene
  // and geometry must outlive the run, which moves the geometry.
  GraphRun(gpu::Device& device, const graph::Description& description, const scene::Scene& scene,
           scene::Geometry& geometry, Options options, Diagnostics& messages);
  // Allocates memory, uploads the scene and compiles shaders. Throws as graph::Executor does. A run of the same scene
  // on the same device that this one replaces hands over the scene on the device, pipelines, and what passes keep
  // (graph::Executor), the latter if `keepContents`; it is of no use afterwards, unless this throws.
  void prepare(GraphRun* before = nullptr, bool keepContents = true);

  const std::shared_ptr<const graph::Plan>& plan() const { return plan_; }
  const graph::BoundGraph& graph() const { return *plan_->graph; }
  const std::vector<std::string>& readback() const { return readback_; }
  // Frame `index` of the scene, whose views have the fovea and the jitter (scene::jitterAt) that the graph's view sets.
  scene::Frame frame(uint64_t index) const;
  scene::Frame frame(const scene::Moment& moment) const;
  // To be called after prepare(). Moves the geometry if a pass reads it, then submits the frame.
  void submit(const scene::Frame& frame, bool readOutputs, bool observe = false,
              std::span<const graph::OutputCopy> copies = {});
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
  std::shared_ptr<scene::GpuScene> gpuScene_;
  std::unique_ptr<graph::Executor> executor_;
};

}  // namespace fovea::session
