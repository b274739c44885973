// When a graph is edited while it runs, the executor of the new plan takes over everything that the edit did not
// change.
#include <algorithm>
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

const PassInstance* findPass(const PassInstances& passes, const std::string& name) {
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

// Whether the same passes with the same shaders write a resource in both plans.
bool sameWriters(const PassInstances& passes, uint32_t resource, const PassInstances& before, uint32_t old) {
  size_t count = 0, countBefore = 0;
  for (const auto& pass : before) countBefore += writes(*pass, old) ? 1 : 0;
  for (const auto& pass : passes) {
    if (!writes(*pass, resource)) continue;
    ++count;
    const PassInstance* same = findPass(before, pass->bound->name);
    if (!same || !writes(*same, old) || !sameKernels(*pass, *same)) return false;
  }
  return count == countBefore;
}

bool sameShape(const ResourceDesc& a, const ResourceDesc& b) {
  return a.kind == b.kind && a.format == b.format && a.width == b.width && a.height == b.height &&
         a.depth == b.depth && a.layers == b.layers && a.mips == b.mips && a.stride == b.stride &&
         a.count == b.count;
}

bool sameValues(const Parameters& a, const Parameters& b) {
  return std::ranges::equal(a.values(), b.values());
}

// Whether nothing about a pass has changed: its parameters and those of the view, and what its ports are wired to.
bool sameInstance(const PassInstance& a, const PassInstance& b) {
  return a.bound->declaration == b.bound->declaration &&
         sameValues(a.bound->parameters, b.bound->parameters) &&
         sameValues(a.state->plan->graph->view, b.state->plan->graph->view) &&
         std::equal(a.bound->accesses.begin(), a.bound->accesses.end(), b.bound->accesses.begin(),
                    b.bound->accesses.end(), [&](const Access& m, const Access& n) {
                      return m.port == n.port && m.member == n.member && sameShape(a.desc(m), b.desc(n));
                    });
}

bool lasts(const BoundResource& resource) {
  return !resource.external && (resource.history || resource.lifetime != Lifetime::Transient);
}

// What a pass on the CPU remembers lies in its object, which has no ties to an executor.
void adoptHostPass(PassInstance& pass, const PassInstances& before) {
  if (pass.bound->declaration->kind != PassKind::Host) return;
  for (const auto& old : before) {
    if (old->bound->name != pass.bound->name || !sameInstance(pass, *old)) continue;
    std::swap(pass.pass, old->pass);
    pass.fresh = false;
  }
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
  for (uint32_t i = 0; i < graph.resources.size(); ++i) {
    const BoundResource& resource = graph.resources[i];
    const auto found = known.find(resource.name);
    if (!state.plan->resourceLive[i] || !lasts(resource) || found == known.end()) continue;
    const uint32_t old = found->second;
    if (!sameMemory(resource, graphBefore.resources[old]) || !sameWriters(passes, i, passesBefore, old))
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
      lasting += lasts(graph.resources[access.resource]) ? 1 : 0;
      adopted += state.adopted[access.resource] ? 1 : 0;
    }
    pass->fresh = lasting == 0 || adopted < lasting;
    if (adopted == lasting) adoptHostPass(*pass, passesBefore);
  }
}

}  // namespace fovea::graph
