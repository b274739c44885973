// The entry points of the graph compiler, which lead from a graph file to a plan. None of them needs a device.
//
//   Diagnostics messages;
//   Description description = load("ir_1000", {overrides, searchPaths}, messages);
//   auto bound = std::make_shared<const BoundGraph>(bind(description, environment, messages));  // throws all errors
//   Plan plan = compile(bound, {memorySizes});
//   for (const Diagnostic& d : messages.list()) ...  // warnings
//
// load() adds the mistakes it finds and continues; bind() adds its own and then throws Error(BadInput) with the
// errors of both, so that all mistakes of a file are reported at once.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fovea/error.h"
#include "framework/graph/compile/plan.h"
#include "framework/graph/pass/registry.h"
#include "framework/graph/resolve/resolve.h"
#include "framework/graph/steps/steps.h"

namespace fovea::graph {

// Parses "radius=3", "blur.radius=3" or "left/blur.radius=3". Throws Error(Usage) if there is no '='.
Override parseOverride(std::string_view text);

// Loads a graph by file name, or by bare name ("ir_1000" for ir_1000.json) from the search paths. Throws
// Error(BadInput) if the file cannot be read, is no JSON or has too many passes; other mistakes go to `diagnostics`.
Description load(const std::string& nameOrPath, const LoadOptions& options, Diagnostics& diagnostics);
// The same for a text (tests, editors). `file` is its name in messages, and `extends` is relative to its folder.
Description loadText(std::string_view text, const std::filesystem::path& file, const LoadOptions& options,
                     Diagnostics& diagnostics);
// The document of such a file with everything it extends merged in, in the order of the base; nothing else about it
// is checked. Throws Error(BadInput) with every mistake.
json::Value loadMerged(const std::string& nameOrPath, const LoadOptions& options);
// The file that load() would read. Throws Error(BadInput) listing where it looked.
std::filesystem::path findGraph(const std::string& nameOrPath,
                                const std::vector<std::filesystem::path>& searchPaths);

// The environment to which a graph is bound. Limits of 0 are unknown and not checked.
struct Environment {
  // Passes without `view` use [0]. If empty, there is one view "main" of 1x1.
  std::vector<std::pair<std::string, VkExtent2D>> views;
  const Registry* registry = nullptr;                       // Registry::global() if nullptr
  std::vector<std::pair<std::string, int64_t>> quantities;  // "scene.triangles", ...; at least 1 each
  std::vector<std::pair<std::string, std::string>> texts;   // what "$scene.materials" and the like stand for
  bool raysOnHost = false;  // where passes that trace rays do so: BoundGraph::raysOnHost
  uint32_t maxImageDimension2D = 0, maxImageDimension3D = 0, maxImageArrayLayers = 0;
  uint64_t maxStorageBufferRange = 0;
  uint64_t maxUniformBufferRange = 0;  // not checked: larger uniform buffers are bound page by page
};

// Resolves types, ports, parameters and sizes. Throws Error(BadInput) with all errors in `diagnostics`, its own and
// earlier ones. Warnings are added to `diagnostics`.
BoundGraph bind(const Description& description, const Environment& environment, Diagnostics& diagnostics);

// Memory requirements of one resource, as the driver reports them.
struct MemoryNeed {
  uint64_t bytes = 0;
  uint64_t alignment = 1;
  uint32_t memoryTypeBits = ~0u;
};
using MemoryTable = std::function<MemoryNeed(uint32_t resource)>;
// Memory requirements without a driver: texels times bytes per texel over all mips and layers, or stride * count,
// aligned to 256.
MemoryNeed estimateMemory(const ResourceDesc& desc);

struct CompileOptions {
  MemoryTable memory;                   // estimateMemory if empty
  uint64_t granularity = 1;             // bufferImageGranularity
  bool alias = true;                    // if false, no two resources share memory
  std::optional<uint32_t> randomOrder;  // tests: seed of a random legal order
  ShaderLookup shaders;                 // if empty, the plan says nothing about steps
};

// Schedules, places and synchronises. Never fails on a graph that bind() accepted.
Plan compile(std::shared_ptr<const BoundGraph> graph, const CompileOptions& options = {});

// Keeps plans by the hash of what they were derived from: graph, memory table and options.
class PlanCache {
 public:
  std::shared_ptr<const Plan> compile(std::shared_ptr<const BoundGraph> graph,
                                      const CompileOptions& options = {});
  size_t size() const { return plans_.size(); }
  size_t hits() const { return hits_; }

 private:
  std::vector<std::shared_ptr<const Plan>> plans_;  // most recent last; only a few
  size_t hits_ = 0;
};

// Adds warnings about a plan for `fovea check`: passes that are culled though no parameter spares them.
void warnAboutPlan(const Plan& plan, Diagnostics& diagnostics);

}  // namespace fovea::graph
