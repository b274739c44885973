// The front door of the graph compiler: from a graph file to a plan. None of this needs a device.
//
//   Diagnostics messages;
//   Description description = load("ir_1000", {overrides, searchPaths}, messages);
//   auto bound = std::make_shared<const BoundGraph>(bind(description, environment, messages));  // throws all
//   errors Plan plan = compile(bound, {memorySizes}); for (const Diagnostic& d : messages.list()) ... //
//   warnings
//
// load() appends the mistakes it finds and goes on; bind() appends its own and then throws Error(BadInput)
// with every error of both, so that all mistakes of a file are reported at once.
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
#include "framework/graph/compile/resolve.h"
#include "framework/graph/pass/registry.h"

namespace fovea::graph {

// "vpl_count=500", "deferred.kernel=disc", "left/deferred.kernel=disc". Throws Error(Usage) when there is no
// '='.
Override parseOverride(std::string_view text);

// A graph by file name, or by bare name ("ir_1000": ir_1000.json) looked up in the search paths. Throws
// Error(BadInput) when the file cannot be read or is no JSON; every other mistake is appended to
// `diagnostics`.
Description load(const std::string& nameOrPath, const LoadOptions& options, Diagnostics& diagnostics);
// The same from text (tests, editors). `file` is the name in messages and the folder that `extends` starts
// from.
Description loadText(std::string_view text, const std::filesystem::path& file, const LoadOptions& options,
                     Diagnostics& diagnostics);
// The document of such a file with all that it extends merged in, in the order of the base; nothing in it is checked beyond
// that. Throws Error(BadInput) with every mistake.
json::Value loadMerged(const std::string& nameOrPath, const LoadOptions& options);
// The file that load() would read; throws Error(BadInput) listing where it looked.
std::filesystem::path findGraph(const std::string& nameOrPath,
                                const std::vector<std::filesystem::path>& searchPaths);

// What a graph is bound to. Limits of 0 are unknown and not checked.
struct Environment {
  std::vector<std::pair<std::string, VkExtent2D>>
      views;                           // [0] is what passes without `view` use; empty: main 1x1
  const Registry* registry = nullptr;  // nullptr: Registry::global()
  std::vector<std::pair<std::string, int64_t>> quantities;  // "scene.triangles", ...: at least 1 each
  uint32_t maxImageDimension2D = 0, maxImageDimension3D = 0, maxImageArrayLayers = 0;
  uint64_t maxStorageBufferRange = 0;
  uint64_t maxUniformBufferRange = 0;  // for information: larger uniform buffers are bound page by page
};

// Types, ports, parameters and sizes. Throws Error(BadInput) with all errors in `diagnostics`, its own and
// earlier ones. Warnings are appended.
BoundGraph bind(const Description& description, const Environment& environment, Diagnostics& diagnostics);

// Memory of one resource as the driver reports it.
struct MemoryNeed {
  uint64_t bytes = 0;
  uint64_t alignment = 1;
  uint32_t memoryTypeBits = ~0u;
};
using MemoryTable = std::function<MemoryNeed(uint32_t resource)>;
// Texels times bytes per texel over all mips and layers, and stride * count, aligned to 256: when there is no
// driver.
MemoryNeed estimateMemory(const ResourceDesc& desc);

struct CompileOptions {
  MemoryTable memory;                   // empty: estimateMemory
  uint64_t granularity = 1;             // bufferImageGranularity
  bool alias = true;                    // false: no two resources share memory
  std::optional<uint32_t> randomOrder;  // a random legal order instead of the deterministic one (tests)
};

// Schedules, places and synchronises. Never fails on a graph that bind() accepted.
Plan compile(std::shared_ptr<const BoundGraph> graph, const CompileOptions& options = {});

// Plans by the hash of what they were derived from: graph, memory table and options.
class PlanCache {
 public:
  std::shared_ptr<const Plan> compile(std::shared_ptr<const BoundGraph> graph,
                                      const CompileOptions& options = {});
  size_t size() const { return plans_.size(); }
  size_t hits() const { return hits_; }

 private:
  std::vector<std::pair<uint64_t, std::shared_ptr<const Plan>>> plans_;  // most recent last; a few
  size_t hits_ = 0;
};

// Warnings about a plan for `fovea check`: passes that are culled, and why nothing needs them.
void warnAboutPlan(const Plan& plan, Diagnostics& diagnostics);

}  // namespace fovea::graph
