// What a frame of a graph results in, and the passes that graphs know. fovea/session.h runs a graph.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fovea/error.h"
#include "fovea/pass.h"

namespace fovea::graph {

// A resource whose sizes have been evaluated.
struct ResourceDesc {
  ResourceKind kind = ResourceKind::Image;
  VkFormat format = VK_FORMAT_UNDEFINED;
  bool volume = false, array = false;
  uint32_t width = 1, height = 1, depth = 1, layers = 1, mips = 1;
  uint32_t light = 0;  // see ResourceSpec::light; 0 in what is read back
  uint32_t stride = 0;
  uint64_t count = 0;   // a buffer has stride * count bytes
  std::string element;  // element type of a buffer
};

// A number, a vector or another part of the elements of a buffer, as shaders declare it.
struct RecordField {
  std::string
      name;  // "start.position" in a struct inside the element; "" if the element is a number or a vector
  uint32_t offset = 0, bytes = 0;
  enum class Type { Int, Uint, Float, Other } type = Type::Other;  // scalar or vector element type
  uint32_t components = 1;  // all elements of a matrix or a tightly packed array
};

// Times in milliseconds. `gpuMs` is the time between the timestamps around the pass; `cpuMs` is the time spent on
// recording the pass or, for a host pass, on executing it. A host pass between two parts of a frame waits for the
// device, and the device then waits for the pass; neither wait is counted.
struct StepTiming {
  std::string name;
  double gpuMs = 0;  // in all its runs together, including the wait for what it depends on
};

// What a pass recorded for the device. Barriers include the one before the level of passes that it is the first of.
struct CommandCounts {
  uint32_t dispatches = 0, indirectDispatches = 0, draws = 0, renderings = 0, transfers = 0, barriers = 0;
  bool operator==(const CommandCounts&) const = default;
};

struct PassTiming {
  uint32_t pass = 0;  // index into the passes of the graph, in the order of the file; see Session::passName
  double gpuMs = 0, cpuMs = 0;
  std::vector<StepTiming> steps;  // those that ran, in the order of their first run; none for a host pass
  CommandCounts commands = {};
  uint64_t operations = 0;  // that its shaders ran, if they count them (graph::ExecutorOptions)
};

// What is read back. Light is in the units of the scene, such as W/(sr m^2), as 32-bit floats whatever format passes
// store it in (ResourceSpec::light).
struct OutputData {
  ResourceDesc desc;
  std::vector<std::byte> bytes;  // tightly packed, layer after layer, then the further mips
  uint64_t beyondRange =
      0;  // texels whose light is no number, or too bright for the format in which it is stored
};

struct FrameResult {
  uint64_t frame = 0;       // Frame::index
  double gpuMs = 0;         // from the first timestamp to the last
  double animateMs = 0;     // the part of gpuMs that moves vertices before the first pass
  double animateCpuMs = 0;  // the part of cpuMs that prepares these vertices
  double cpuMs = 0;         // recording, and executing host passes
  double observeMs = 0;     // the part of gpuMs that copies observed resources (Executor::observe)
  double wallMs = 0;        // since the previous frame finished or, for the first one, since submission
  std::vector<PassTiming> passes;                        // in order of execution
  std::vector<std::pair<std::string, double>> counters;  // "blur.shaded_pixels"
  std::map<std::string, OutputData> outputs;             // only those that were requested
};

// Loads a shared library whose FOVEA_PASS registrations add pass types to the process. Its shaders are looked up in a
// folder `shaders` next to it. Throws Error(BadInput) if the file is not a plug-in, or is one for another version of
// fovea, or if a declaration contradicts itself, and Error(Internal) if a declaration throws an exception.
void loadPlugin(const std::filesystem::path& file);

// Adds the passes declared by the files NAME.pass.json in a folder. Throws Error(BadInput) with every mistake.
void addPasses(const std::filesystem::path& folder);
// Declares the passes of such files anew whose text has changed, for sessions and parameters that are set from now on.
// Throws as addPasses() does; the passes of wrong files stay as they were.
void rereadPasses();

// Adds a pass whose objects `make` returns. One that was added in this way before is replaced for sessions made and
// parameters set from now on. Throws Error(Internal) if the declaration contradicts itself or belongs to another pass.
void addPass(PassDeclaration declaration, std::function<std::unique_ptr<Pass>()> make);

// The declaration of a pass on the CPU (PassKind::Host): what NAME.pass.json holds, without steps. `source` is the
// name of the text in messages. Throws Error(BadInput) with every mistake.
PassDeclaration hostPass(const std::string& type, std::string_view json, const std::string& source);

// Every pass type that the process knows, sorted. The declarations stay valid.
std::vector<const PassDeclaration*> passTypes();

}  // namespace fovea::graph
