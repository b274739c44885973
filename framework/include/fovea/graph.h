// Graphs for programs: a graph file run over a scene on a device, frame after frame, and what comes out of it.
//
//   scene::Scene scene = scene::load("atrium", messages);
//   graph::Session session("ir_1000", scene, {.size = {512, 512}, .set = {"vpl_count=500"}});
//   graph::FrameResult frame = session.render(0);
//   image::Image picture = session.picture(frame, "radiance");
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fovea/error.h"
#include "fovea/image.h"
#include "fovea/pass.h"

namespace fovea::scene {
struct Scene;
}

namespace fovea::graph {

// A resource with its sizes evaluated.
struct ResourceDesc {
  ResourceKind kind = ResourceKind::Image;
  VkFormat format = VK_FORMAT_UNDEFINED;
  bool volume = false, array = false;
  uint32_t width = 1, height = 1, depth = 1, layers = 1, mips = 1;
  uint32_t stride = 0;
  uint64_t count = 0;   // bytes = stride * count
  std::string element;  // buffers
};

// Milliseconds. `gpuMs` lies between the timestamps around the pass; `cpuMs` is spent on recording it, or on executing
// it if it is a host pass. While a host pass executes between two parts of a frame, the device waits for it, and it has
// waited for the device: neither counts twice.
struct PassTiming {
  uint32_t pass = 0;  // index into the passes of the graph, in the order of the file; see Session::passName
  double gpuMs = 0, cpuMs = 0;
};

struct OutputData {
  ResourceDesc desc;
  std::vector<std::byte> bytes;  // tightly packed, layer after layer, then further mips
};

struct FrameResult {
  uint64_t frame = 0;       // Frame::index
  double gpuMs = 0;         // from the first timestamp to the last
  double animateMs = 0;     // the part of gpuMs that moves vertices, before the passes
  double animateCpuMs = 0;  // the part of cpuMs that prepares this
  double cpuMs = 0;         // recording, and executing host passes
  double wallMs = 0;        // since the previous frame was finished; for the first one since it was submitted
  std::vector<PassTiming> passes;                        // in order of execution
  std::vector<std::pair<std::string, double>> counters;  // "deferred.shaded_pixels"
  std::map<std::string, OutputData> outputs;             // only where they were asked for
};

// Loads a shared library whose FOVEA_PASS registrations join the passes that the process knows. Its shaders are looked up
// in a folder `shaders` beside it. Throws Error(BadInput) with the loader's reason.
void loadPlugin(const std::filesystem::path& file);

struct SessionOptions {
  std::string device;         // number or part of the name; "": the best one
  bool validation = false;    // run under the Vulkan validation layers
  glm::uvec2 size{512, 512};  // pixels
  uint32_t seed = 1;
  double frameRate = 42;             // frames a second of the scene's time
  std::vector<std::string> set;      // "vpl_count=500", "deferred.kernel=disc"
  std::vector<std::string> outputs;  // what is read back; empty: every output of the graph
};

class Session {
 public:
  // `graph` is a file or a bare name. The scene must outlive the session. Throws Error(BadInput) with every mistake of the
  // graph, Error(NoDevice), Error(OutOfMemory).
  Session(const std::string& graph, const scene::Scene& scene, const SessionOptions& options = {});
  ~Session();

  // Renders frame `index` of the scene's time and waits for it.
  FrameResult render(uint64_t index);
  // A floating-point or normalised output as a picture. Throws Error(Usage) on a name that was not read back.
  image::Image picture(const FrameResult& frame, const std::string& output) const;
  const std::string& passName(uint32_t pass) const;
  const Diagnostics& warnings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::graph
