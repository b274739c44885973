#include "framework/graph/compile/alias.h"

#include <algorithm>
#include <memory_resource>
#include <numeric>

#include "framework/gpu/format.h"

namespace fovea::graph {
namespace {

// Vulkan's alignments are powers of two.
uint64_t alignUp(uint64_t v, uint64_t alignment) { return (v + alignment - 1) & ~(alignment - 1); }

struct Range {
  uint64_t begin, end;
};

// What is occupied of one heap: sorted ranges that do not touch each other. Adjacent resources merge into one range, so
// that a level with hundreds of them still has few ranges.
using Occupied = std::pmr::vector<Range>;

void occupy(Occupied& occupied, Range range) {
  const auto first = std::lower_bound(occupied.begin(), occupied.end(), range.begin,
                                      [](const Range& before, uint64_t begin) { return before.end < begin; });
  auto end = first;
  for (; end != occupied.end() && end->begin <= range.end; ++end)
    range = {std::min(range.begin, end->begin), std::max(range.end, end->end)};
  if (first == end) {
    occupied.insert(first, range);
  } else {
    *first = range;
    occupied.erase(first + 1, end);
  }
}

// The tightest aligned gap of `bytes` that is free in all of these levels. `merged` is room for work.
uint64_t findGap(std::span<const Occupied> levels, uint64_t bytes, uint64_t alignment, Occupied& merged) {
  merged.clear();
  for (const Occupied& occupied : levels) merged.insert(merged.end(), occupied.begin(), occupied.end());
  std::sort(merged.begin(), merged.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
  uint64_t end = 0, best = 0, bestRoom = ~0ull;
  for (const Range& range : merged) {
    const uint64_t at = alignUp(end, alignment);
    if (range.begin >= at && range.begin - at >= bytes && range.begin - at < bestRoom) {
      best = at;
      bestRoom = range.begin - at;
    }
    end = std::max(end, range.end);
  }
  return bestRoom == ~0ull ? alignUp(end, alignment) : best;
}

// From the largest to the smallest.
std::vector<uint32_t> placingOrder(std::span<const AliasRequest> requests) {
  std::vector<uint32_t> order(requests.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const AliasRequest &x = requests[a], &y = requests[b];
    if (x.need.bytes != y.need.bytes) return x.need.bytes > y.need.bytes;
    if (x.interval.first != y.interval.first) return x.interval.first < y.interval.first;
    return x.resource < y.resource;
  });
  return order;
}

uint32_t heapOf(std::vector<Plan::Heap>& heaps, uint32_t memoryTypeBits) {
  uint32_t h = 0;
  while (h < heaps.size() && heaps[h].memoryTypeBits != memoryTypeBits) ++h;
  if (h == heaps.size()) heaps.push_back({0, memoryTypeBits});
  return h;
}

}  // namespace

MemoryNeed estimateMemory(const ResourceDesc& desc) {
  constexpr uint64_t kAlignment = 256;
  uint64_t bytes = 0;
  if (desc.kind == ResourceKind::Buffer) {
    bytes = desc.count * desc.stride;
  } else {
    const uint64_t texel = gpu::formatInfo(desc.format).bytesPerTexel;
    for (uint32_t mip = 0; mip < desc.mips; ++mip)
      bytes += uint64_t(std::max(1u, desc.width >> mip)) * std::max(1u, desc.height >> mip) *
               std::max(1u, desc.depth >> mip) * desc.layers * texel;
  }
  return {alignUp(bytes, kAlignment), kAlignment, ~0u};
}

AliasResult placeResources(std::span<const AliasRequest> requests, uint64_t granularity, bool alias) {
  AliasResult result;
  uint32_t levels = 0;
  for (const AliasRequest& request : requests) {
    result.placements.push_back({request.resource, heapOf(result.heaps, request.need.memoryTypeBits)});
    levels = std::max(levels, request.interval.last + 1);
  }
  // The lists of thousands of levels take their memory from one buffer; allocating each costs half as much again.
  std::pmr::monotonic_buffer_resource memory;
  std::pmr::vector<std::pmr::vector<Occupied>> occupied(result.heaps.size(), &memory);
  for (std::pmr::vector<Occupied>& heap : occupied) heap.resize(levels);
  Occupied merged;
  for (const uint32_t i : placingOrder(requests)) {
    const MemoryNeed& need = requests[i].need;
    const Interval lives = alias ? requests[i].interval : Interval{0, levels - 1};
    Placement& placement = result.placements[i];
    const uint64_t alignment = std::max<uint64_t>({need.alignment, granularity, 1});
    const std::span<Occupied> during =
        std::span(occupied[placement.heap]).subspan(lives.first, lives.last - lives.first + 1);
    placement.bytes = alignUp(std::max<uint64_t>(need.bytes, 1), alignment);
    placement.offset = findGap(during, placement.bytes, alignment, merged);
    for (Occupied& level : during) occupy(level, {placement.offset, placement.offset + placement.bytes});
    uint64_t& size = result.heaps[placement.heap].bytes;
    size = std::max(size, placement.offset + placement.bytes);
    result.bytesUnaliased += placement.bytes;
  }
  for (const Plan::Heap& heap : result.heaps) result.bytesAliased += heap.bytes;
  return result;
}

}  // namespace fovea::graph
