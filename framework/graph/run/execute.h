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

#include "fovea/graph.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/compile/plan.h"

namespace fovea::gpu {
class Device;
}
namespace fovea::scene {
struct Frame;
class FrameDescriptors;
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

// Memory that a bound resource needs on the device; feeds the aliasing phase.
MemoryNeed deviceMemory(gpu::Device& device, const BoundResource& resource);

// compile() for a device: sizes as its driver reports them.
CompileOptions deviceCompileOptions(gpu::Device& device, std::shared_ptr<const BoundGraph> graph);

// The limits of a device as a graph is checked against them; nullptr: they are unknown. Views and quantities are the
// caller's.
Environment deviceEnvironment(const gpu::Device* device);

class Executor {
 public:
  // Allocates all memory and prepares all passes (compiles their shaders). Throws Error(OutOfMemory) naming
  // the resource and its size, Error(BadInput) for shaders that do not compile or bind.
  Executor(gpu::Device& device, std::shared_ptr<const Plan> plan, const Registry& registry,
           scene::FrameDescriptors& scene, const ExecutorOptions& options = {});
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
