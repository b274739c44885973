// Replays a plan on a device, frame after frame, without allocating, compiling, waiting or reading back
// inside the loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "framework/graph/compile.h"
#include "framework/graph/plan.h"

namespace fovea::gpu {
class Device;
}
namespace fovea::scene {
struct Frame;
struct Geometry;
struct Scene;
class GpuScene;
}  // namespace fovea::scene

namespace fovea::graph {

class Registry;

// What a host pass that takes long has to say: its name and the share of its work that is done; false asks it
// to end soon, with what it has.
using HostProgress = std::function<bool(const std::string& pass, double share)>;

struct ExecutorOptions {
  uint32_t framesInFlight = 2;
  std::vector<std::string> readback;  // graph outputs that frames may ask to have read back
  HostProgress hostProgress;          // called inside submit()
};

// Milliseconds. gpu: between the timestamps around the pass; cpu: recording it, or executing it if it is a
// host pass. While a host pass executes between two parts of a frame the device waits for it, and it has
// waited for the device: neither counts twice.
struct PassTiming {
  uint32_t pass = 0;  // index into BoundGraph::passes
  double gpuMs = 0, cpuMs = 0;
};

struct OutputData {
  ResourceDesc desc;
  std::vector<std::byte> bytes;  // tightly packed, layer after layer, then further mips
};

struct FrameResult {
  uint64_t frame = 0;    // Frame::index
  double gpuMs = 0;      // first to last timestamp
  double animateMs = 0;  // of it, before the passes: the vertices of what moves
  double animateCpuMs = 0;
  double cpuMs = 0;   // recording and host passes
  double wallMs = 0;  // since the previous frame was finished; the first frame: since it was submitted
  std::vector<PassTiming> passes;                        // in order of execution
  std::vector<std::pair<std::string, double>> counters;  // "deferred.pairs"
  std::map<std::string, OutputData> outputs;             // only when asked for
};

// Memory that a bound resource needs on the device; feeds the aliasing phase.
MemoryNeed deviceMemory(gpu::Device& device, const BoundResource& resource);

// compile() for a device: sizes as its driver reports them.
CompileOptions deviceCompileOptions(gpu::Device& device, std::shared_ptr<const BoundGraph> graph);

// The views that scene::makeFrame gives every frame.
std::vector<std::pair<std::string, VkExtent2D>> frameViews(VkExtent2D size);

// What a graph is bound to: views, the device's limits (device may be null: unknown) and the scene's
// quantities.
Environment sceneEnvironment(const gpu::Device* device, const scene::Scene& scene,
                             const scene::Geometry& geometry,
                             std::vector<std::pair<std::string, VkExtent2D>> views);

class Executor {
 public:
  // Allocates all memory and prepares all passes (compiles their shaders). Throws Error(OutOfMemory) naming
  // the resource and its size, Error(BadInput) for shaders that do not compile or bind.
  Executor(gpu::Device& device, std::shared_ptr<const Plan> plan, const Registry& registry,
           scene::GpuScene& scene, const ExecutorOptions& options = {});
  ~Executor();

  // Contents of an input of the whole graph ("radiance", "gbuffer.position"); kept until set again. Waits.
  void setInput(const std::string& name, std::span<const std::byte> bytes);

  // Records and submits one frame. Blocks only while framesInFlight frames are unfinished, or for a host pass
  // that reads what this frame's GPU passes wrote.
  void submit(const scene::Frame& frame, bool readOutputs = false);

  // The oldest frame that has finished and was not returned yet; nullopt if there is none. Never blocks.
  std::optional<FrameResult> poll();
  // Waits for the oldest unreturned frame; nullopt when every submitted frame was returned.
  std::optional<FrameResult> next();

  // Whether a pass works on the CPU, and so reads Frame::geometry as it is in the frame; the vertices that
  // GPU passes see come from Frame::objects, joints and weights alone.
  bool readsGeometry() const;

  uint64_t residentBytes() const;  // device memory held by this executor

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::graph
