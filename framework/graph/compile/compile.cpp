// The driver: one phase after the other, each a function of the results of the phases before it.
//   document -> resolve (load), bind, schedule -> lifetimes -> alias -> barriers -> steps -> plan (compile)
#include "framework/graph/compile/compile.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "framework/base/hash.h"
#include "framework/graph/compile/alias.h"
#include "framework/graph/compile/barriers.h"
#include "framework/graph/compile/schedule.h"
#include "framework/graph/document/document.h"
#include "framework/graph/migrate/migrate.h"
#include "framework/graph/resolve/expand.h"

namespace fovea::graph {
namespace {

// By resource; of live resources that are not the caller's.
std::vector<MemoryNeed> memoryNeeds(const BoundGraph& graph, const Schedule& order,
                                    const CompileOptions& options) {
  std::vector<MemoryNeed> needs(graph.resources.size());
  for (uint32_t r = 0; r < needs.size(); ++r)
    if (order.resourceLive[r] && !graph.resources[r].external)
      needs[r] = options.memory ? options.memory(r) : estimateMemory(graph.resources[r].desc);
  return needs;
}

// The hash of everything that a plan is derived from, and hence its key in a cache.
uint64_t planHash(const BoundGraph& graph, const std::vector<MemoryNeed>& needs,
                  const CompileOptions& options) {
  Hasher hash;
  hash.add(graph.hash);
  for (const MemoryNeed& need : needs) hash.add(need.bytes, need.alignment << 32 | need.memoryTypeBits);
  hash.add(options.granularity << 1 | options.alias);
  hash.add(options.randomOrder ? uint64_t(*options.randomOrder) + 1 : uint64_t(0));
  return hash.value();
}

std::vector<AliasRequest> aliasRequests(const BoundGraph& graph, const Schedule& order,
                                        const std::vector<Interval>& lives,
                                        const std::vector<MemoryNeed>& needs) {
  std::vector<AliasRequest> requests;
  requests.reserve(needs.size());
  for (uint32_t r = 0; r < needs.size(); ++r)
    if (order.resourceLive[r] && isTransient(graph.resources[r])) requests.push_back({r, lives[r], needs[r]});
  return requests;
}

std::vector<std::vector<PlannedStep>> stepsOf(const BoundGraph& graph, const Schedule& order,
                                              const CompileOptions& options) {
  std::vector<std::vector<PlannedStep>> steps(options.shaders ? graph.passes.size() : 0);
  for (uint32_t p = 0; p < steps.size(); ++p)
    if (order.passLive[p]) steps[p] = planSteps(graph, graph.passes[p], options.shaders);
  return steps;
}

uint64_t bytesKept(const BoundGraph& graph, const std::vector<MemoryNeed>& needs) {
  uint64_t bytes = 0;
  for (size_t r = 0; r < needs.size(); ++r)
    if (!isTransient(graph.resources[r])) bytes += needs[r].bytes * (graph.resources[r].history ? 2 : 1);
  return bytes;
}

}  // namespace

Description load(const std::string& nameOrPath, const LoadOptions& options, Diagnostics& diagnostics) {
  const std::filesystem::path file = findGraph(nameOrPath, options.searchPaths);
  return resolve(std::make_shared<const json::Value>(detail::readGraphFile(file, diagnostics)), file, options,
                 diagnostics);
}

Description loadText(std::string_view text, const std::filesystem::path& file, const LoadOptions& options,
                     Diagnostics& diagnostics) {
  return resolve(Document::parse(text, file), options, diagnostics);
}

Plan compile(std::shared_ptr<const BoundGraph> graph, const CompileOptions& options) {
  Schedule order = schedule(*graph, options.randomOrder);
  const std::vector<Interval> lives = lifetimes(*graph, order);
  const std::vector<MemoryNeed> needs = memoryNeeds(*graph, order, options);
  AliasResult memory =
      placeResources(aliasRequests(*graph, order, lives, needs), options.granularity, options.alias);
  Barriers barriers = placeBarriers(*graph, order, lives, memory.placements);
  Plan plan;
  plan.levels = std::move(barriers.levels);
  plan.end = std::move(barriers.end);
  plan.steps = stepsOf(*graph, order, options);
  plan.placements = std::move(memory.placements);
  plan.heaps = std::move(memory.heaps);
  plan.passLive = std::move(order.passLive);
  plan.resourceLive = std::move(order.resourceLive);
  plan.startLayout = std::move(barriers.startLayout);
  plan.endLayout = std::move(barriers.endLayout);
  plan.bytesAliased = memory.bytesAliased;
  plan.bytesUnaliased = memory.bytesUnaliased;
  plan.bytesKept = bytesKept(*graph, needs);
  plan.hash = planHash(*graph, needs, options);
  plan.graph = std::move(graph);
  return plan;
}

std::shared_ptr<const Plan> PlanCache::compile(std::shared_ptr<const BoundGraph> graph,
                                               const CompileOptions& options) {
  constexpr size_t kKept = 8;
  const Schedule order = schedule(*graph, options.randomOrder);
  const uint64_t key = planHash(*graph, memoryNeeds(*graph, order, options), options);
  const auto known =
      std::find_if(plans_.begin(), plans_.end(), [&](const auto& plan) { return plan->hash == key; });
  if (known != plans_.end()) {
    ++hits_;
    std::rotate(known, known + 1, plans_.end());
    return plans_.back();
  }
  if (plans_.size() >= kKept) plans_.erase(plans_.begin());
  return plans_.emplace_back(std::make_shared<const Plan>(graph::compile(std::move(graph), options)));
}

void warnAboutPlan(const Plan& plan, Diagnostics& diagnostics) {
  const BoundGraph& graph = *plan.graph;
  for (size_t p = 0; p < graph.passes.size(); ++p)
    if (!plan.passLive[p] && !graph.passes[p].spared)
      diagnostics.warning(
          {}, "passes." + graph.passes[p].name,
          fmt::format("pass `{}` does not run: nothing needs what it makes", graph.passes[p].name),
          "wire one of its outputs, or remove it");
}

}  // namespace fovea::graph
