// When a graph is edited while it runs, the executor of the new plan takes over everything that the edit did not
// change.
#include <algorithm>
#include <set>
#include <utility>

#include "framework/graph/run/frame_slot.h"

namespace fovea::graph {
namespace {

bool sameMemory(const BoundResource& a, const BoundResource& b) {
  if (a.desc.kind != b.desc.kind || a.history != b.history || a.lifetime != b.lifetime) return false;
  if (a.desc.kind == ResourceKind::Buffer) {
    const gpu::BufferDesc x = bufferDesc(a), y = bufferDesc(b);
    return x.bytes == y.bytes && x.usage == y.usage && a.desc.stride == b.desc.stride &&
           a.desc.element == b.desc.element;
  }
  const gpu::ImageDesc x = imageDesc(a), y = imageDesc(b);
  return x.type == y.type && x.format == y.format && x.width == y.width && x.height == y.height &&
         x.depth == y.depth && x.layers == y.layers && x.mips == y.mips && x.array == y.array &&
         x.usage == y.usage;
}

PassInstance* findPass(const PassInstances& passes, const std::string& name) {
  for (const auto& pass : passes)
    if (pass->bound->name == name) return pass.get();
  return nullptr;
}

bool sameKernels(const PassInstance& a, const PassInstance& b) {
  return a.bound->declaration->type == b.bound->declaration->type &&
         std::equal(a.kernels.begin(), a.kernels.end(), b.kernels.begin(), b.kernels.end(),
                    [](const KernelState& x, const KernelState& y) { return x.key == y.key; });
}

bool writes(const PassInstance& pass, uint32_t resource) {
  return std::any_of(pass.bound->accesses.begin(), pass.bound->accesses.end(),
                     [&](const Access& a) { return a.writes && a.resource == resource; });
}

bool sameShape(const ResourceDesc& a, const ResourceDesc& b) {
  return a.kind == b.kind && a.format == b.format && a.width == b.width && a.height == b.height &&
         a.depth == b.depth && a.layers == b.layers && a.mips == b.mips && a.stride == b.stride &&
         a.count == b.count;
}

bool sameValues(const Parameters& a, const Parameters& b) {
  return std::ranges::equal(a.values(), b.values());
}

const BoundResource& resourceOf(const PassInstance& pass, const Access& access) {
  return pass.state->plan->graph->resources[access.resource];
}

// Whether nothing about a pass has changed: its parameters, its shaders, and what its ports are wired to.
bool sameInstance(const PassInstance& a, const PassInstance& b) {
  return a.bound->declaration == b.bound->declaration && sameKernels(a, b) &&
         sameValues(a.bound->parameters, b.bound->parameters) &&
         std::equal(a.bound->accesses.begin(), a.bound->accesses.end(), b.bound->accesses.begin(),
                    b.bound->accesses.end(), [&](const Access& m, const Access& n) {
                      return m.port == n.port && m.member == n.member && m.previous == n.previous &&
                             resourceOf(a, m).name == resourceOf(b, n).name &&
                             sameShape(a.desc(m), b.desc(n));
                    });
}

// Each pass with its predecessor, where nothing about it has changed.
using Unchanged = std::map<const PassInstance*, PassInstance*>;

Unchanged unchangedPasses(const PassInstances& passes, const PassInstances& before) {
  Unchanged unchanged;
  for (const auto& pass : passes) {
    PassInstance* old = findPass(before, pass->bound->name);
    if (old && sameInstance(*pass, *old)) unchanged.emplace(pass.get(), old);
  }
  return unchanged;
}

// Whether the same passes with the same shaders write a resource in both plans. What is kept for the scene was made once,
// so the parameters of its writers must be the same, too; a history continues when they change.
bool sameWriters(const PassInstances& passes, uint32_t resource, const PassInstances& before, uint32_t old,
                 const Unchanged& unchanged) {
  const bool kept = passes.front()->state->plan->graph->resources[resource].lifetime == Lifetime::Scene;
  size_t count = 0, countBefore = 0;
  for (const auto& pass : before) countBefore += writes(*pass, old) ? 1 : 0;
  for (const auto& pass : passes) {
    if (!writes(*pass, resource)) continue;
    ++count;
    const PassInstance* same = findPass(before, pass->bound->name);
    if (!same || !writes(*same, old) || !sameKernels(*pass, *same)) return false;
    if (kept && !unchanged.contains(pass.get())) return false;
  }
  return count == countBefore;
}

NameMap<std::set<std::string>> writersByResource(const PassInstances& passes) {
  NameMap<std::set<std::string>> writers;
  for (const auto& pass : passes)
    for (const Access& access : pass->bound->accesses)
      if (access.writes) writers[resourceOf(*pass, access).name].insert(pass->bound->name);
  return writers;
}

// Of the passes that have not changed, those whose inputs come from such passes only.
Unchanged undisturbedPasses(Unchanged unchanged, const PassInstances& passes, const PassInstances& before) {
  const NameMap<std::set<std::string>> writers = writersByResource(passes), old = writersByResource(before);
  std::set<std::string> disturbed;  // resources
  for (const auto& [name, of] : writers)
    if (const auto found = old.find(name); found == old.end() || found->second != of) disturbed.insert(name);
  const auto disturb = [&](const PassInstance& pass) {
    for (const Access& access : pass.bound->accesses)
      if (access.writes) disturbed.insert(resourceOf(pass, access).name);
  };
  for (const auto& pass : passes)
    if (!unchanged.contains(pass.get())) disturb(*pass);
  // What a pass reads of the previous frame may come from one after it.
  for (bool more = true; more;) {
    more = false;
    for (const auto& pass : passes) {
      const bool reached = std::ranges::any_of(pass->bound->accesses, [&](const Access& access) {
        return disturbed.contains(resourceOf(*pass, access).name);
      });
      if (!reached || unchanged.erase(pass.get()) == 0) continue;
      disturb(*pass);
      more = true;
    }
  }
  return unchanged;
}

bool lasts(const BoundResource& resource) {
  return !resource.external && (resource.history || resource.lifetime != Lifetime::Transient);
}

// Whether a pass keeps what it accesses: not where it reads what others make of the scene.
bool keeps(const PassInstance& pass, const Access& access) {
  const BoundResource& resource = resourceOf(pass, access);
  return lasts(resource) && (access.writes || resource.history || resource.lifetime != Lifetime::Scene);
}

bool sameHeaps(const Plan& a, const Plan& b) {
  return std::ranges::equal(a.heaps, b.heaps,
                            [](const Plan::Heap& m, const Plan::Heap& n) {
                              return m.bytes == n.bytes && m.memoryTypeBits == n.memoryTypeBits;
                            }) &&
         std::ranges::equal(a.placements, b.placements, [&](const Placement& m, const Placement& n) {
           return m.heap == n.heap && m.offset == n.offset && m.resource == n.resource &&
                  sameMemory(a.graph->resources[m.resource], b.graph->resources[n.resource]);
         });
}

// Transient resources have no contents to keep, but the first frame in new memory pays for its pages.
void adoptHeaps(ExecutorState& state, ExecutorState& before) {
  if (!sameHeaps(*state.plan, *before.plan)) return;
  std::swap(state.heaps, before.heaps);
  for (const Placement& placement : state.plan->placements)
    std::swap(state.resources[placement.resource], before.resources[placement.resource]);
}

// What a pass on the CPU remembers lies in its object, which has no ties to an executor. Views are among its parameters.
void adoptHostPass(PassInstance& pass, PassInstance& old) {
  if (!sameValues(pass.state->plan->graph->view, old.state->plan->graph->view)) return;
  std::swap(pass.pass, old.pass);
  pass.fresh = false;
}

}  // namespace

std::map<std::string, std::shared_ptr<gpu::Pipeline>, std::less<>> pipelinesOf(const PassInstances& passes) {
  std::map<std::string, std::shared_ptr<gpu::Pipeline>, std::less<>> pipelines;
  for (const auto& pass : passes)
    for (const KernelState& kernel : pass->kernels) pipelines.emplace(kernel.key, kernel.pipeline);
  return pipelines;
}

void adoptResources(ExecutorState& state, PassInstances& passes, ExecutorState& before,
                    const PassInstances& passesBefore) {
  const BoundGraph& graph = *state.plan->graph;
  const BoundGraph& graphBefore = *before.plan->graph;
  NameMap<uint32_t> known;
  for (uint32_t i = 0; i < graphBefore.resources.size(); ++i)
    if (before.plan->resourceLive[i] && lasts(graphBefore.resources[i]))
      known.emplace(graphBefore.resources[i].name, i);
  adoptHeaps(state, before);
  const Unchanged unchanged = unchangedPasses(passes, passesBefore),
                  undisturbed = undisturbedPasses(unchanged, passes, passesBefore);
  for (uint32_t i = 0; i < graph.resources.size(); ++i) {
    const BoundResource& resource = graph.resources[i];
    const auto found = known.find(resource.name);
    if (!state.plan->resourceLive[i] || !lasts(resource) || found == known.end()) continue;
    const uint32_t old = found->second;
    if (!sameMemory(resource, graphBefore.resources[old]) ||
        !sameWriters(passes, i, passesBefore, old, unchanged))
      continue;
    const std::array<VkImageLayout, 2> layouts = before.plan->startLayout[old];
    // Without a layout, an image has no contents to keep.
    if (resource.desc.kind == ResourceKind::Image &&
        (layouts[0] == VK_IMAGE_LAYOUT_UNDEFINED ||
         (resource.history && layouts[1] == VK_IMAGE_LAYOUT_UNDEFINED)))
      continue;
    std::swap(state.resources[i], before.resources[old]);
    state.adopted[i] = layouts;
  }
  for (const auto& pass : passes) {
    uint32_t lasting = 0, adopted = 0;
    for (const Access& access : pass->bound->accesses) {
      if (!keeps(*pass, access)) continue;
      ++lasting;
      adopted += state.adopted[access.resource] ? 1 : 0;
    }
    pass->fresh = lasting == 0 || adopted < lasting;
    if (adopted < lasting) continue;
    if (const auto old = undisturbed.find(pass.get()); old != undisturbed.end())
      pass->memory = std::move(old->second->memory);
    if (const auto old = unchanged.find(pass.get());
        old != unchanged.end() && pass->bound->declaration->kind == PassKind::Host)
      adoptHostPass(*pass, *old->second);
  }
}

}  // namespace fovea::graph
