#include "framework/graph/report/traffic.h"

#include <algorithm>

#include "framework/gpu/format.h"

namespace fovea::graph {
namespace {

bool isPicture(const ResourceDesc& d) { return d.kind == ResourceKind::Image && !d.volume && !d.array; }

uint64_t bytesOf(const ResourceDesc& d) {
  if (d.kind == ResourceKind::Buffer) return d.count * d.stride;
  uint64_t texels = 0;
  for (uint32_t mip = 0; mip < d.mips; ++mip)
    texels += uint64_t(std::max(d.width >> mip, 1u)) * std::max(d.height >> mip, 1u) *
              std::max(d.depth >> mip, 1u) * d.layers;
  return texels * gpu::formatInfo(d.format).bytesPerTexel;
}

}  // namespace

std::vector<PassTraffic> traffic(const Plan& plan) {
  const BoundGraph& graph = *plan.graph;
  std::vector<PassTraffic> list(graph.passes.size());
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    if (!plan.passLive[p]) continue;
    for (const Access& a : graph.passes[p].accesses) {
      const ResourceDesc& desc = graph.resources[a.resource].desc;
      const uint64_t bytes = bytesOf(desc);
      (isPicture(desc) ? list[p].pictures : list[p].others) +=
          Traffic{a.reads ? bytes : 0, a.writes ? bytes : 0};
    }
  }
  return list;
}

uint64_t outputPixels(const BoundGraph& graph) {
  uint64_t most = 0;
  for (const BoundOutput& o : graph.outputs) {
    const ResourceDesc& desc = graph.resources[o.resource].desc;
    if (isPicture(desc)) most = std::max(most, uint64_t(desc.width) * desc.height);
  }
  return most;
}

}  // namespace fovea::graph
