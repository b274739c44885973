#include "framework/graph/compile/alias.h"

#include <algorithm>

#include "framework/base/small_vector.h"
#include "framework/graph/compile/scratch.h"

namespace fovea::graph {
namespace {

struct Range {
  uint64_t begin, end;
};

// The occupied ranges of one heap per level, sorted and not touching each other. Adjacent resources merge into one
// range, so that a level with hundreds of them still has few ranges.
class Occupancy {
 public:
  Occupancy(detail::Scratch& scratch, uint32_t levels) : levels_(levels, scratch), merged_(scratch) {}

  // Tightest aligned gap of `bytes` that is free in all levels of the interval.
  uint64_t findGap(const Interval& interval, uint64_t bytes, uint64_t alignment) {
    const std::span<const Range> taken = takenDuring(interval);
    uint64_t end = 0, best = 0, bestRoom = ~0ull;
    for (const Range& range : taken) {
      const uint64_t at = alignUp(end, alignment);
      if (range.begin >= at && range.begin - at >= bytes && range.begin - at < bestRoom) {
        best = at;
        bestRoom = range.begin - at;
      }
      end = std::max(end, range.end);
    }
    return bestRoom == ~0ull ? alignUp(end, alignment) : best;
  }

  void take(const Interval& interval, Range range) {
    for (uint32_t l = interval.first; l <= interval.last; ++l) {
      SmallVector<Range, 2>& taken = levels_[l];
      if (taken.empty() || taken.end()[-1].end < range.begin)
        taken.push_back(range);
      else if (taken.end()[-1].end == range.begin)
        taken.end()[-1].end = range.end;
      else
        insert(taken, range);
    }
  }

  // Vulkan's alignments are powers of two.
  static uint64_t alignUp(uint64_t v, uint64_t alignment) { return (v + alignment - 1) & ~(alignment - 1); }

 private:
  // Inserts a range that begins before the last one does.
  static void insert(SmallVector<Range, 2>& taken, Range range) {
    Range* const next = std::lower_bound(taken.begin(), taken.end(), range,
                                         [](const Range& a, const Range& b) { return a.begin < b.begin; });
    const bool joinsNext = next->begin == range.end;
    const bool joinsLast = next != taken.begin() && next[-1].end == range.begin;
    if (joinsLast && joinsNext) {
      next[-1].end = next->end;
      taken.erase(next);
    } else if (joinsLast) {
      next[-1].end = range.end;
    } else if (joinsNext) {
      next->begin = range.begin;
    } else {
      taken.insert(next, range);
    }
  }

  // What is occupied in any level of the interval, sorted.
  std::span<const Range> takenDuring(const Interval& interval) {
    uint32_t filled = 0, latestFilled = interval.first;
    for (uint32_t l = interval.first; l <= interval.last; ++l) {
      if (levels_[l].empty()) continue;
      latestFilled = l;
      ++filled;
    }
    if (filled <= 1) return levels_[latestFilled];  // for images of one size in the order of their lifetimes
    merged_.clear();
    uint64_t latest = 0;
    bool sorted = true;
    for (uint32_t l = interval.first; l <= interval.last; ++l) {
      for (const Range& range : levels_[l]) {
        sorted &= range.begin >= latest;
        latest = range.begin;
        merged_.push_back(range);
      }
    }
    if (!sorted)
      std::sort(merged_.begin(), merged_.end(),
                [](const Range& a, const Range& b) { return a.begin < b.begin; });
    return merged_;
  }

  detail::ScratchVector<SmallVector<Range, 2>> levels_;
  detail::ScratchVector<Range> merged_;
};

}  // namespace

AliasResult placeResources(std::span<const AliasRequest> requests, uint64_t granularity, bool alias) {
  AliasResult result;
  result.placements.resize(requests.size());
  if (requests.empty()) return result;
  detail::Scratch scratch;
  detail::ScratchVector<Occupancy> heaps(scratch);
  const std::span<uint32_t> order = scratch.array<uint32_t>(requests.size());
  uint32_t levels = 0;
  for (uint32_t i = 0; i < requests.size(); ++i) {
    order[i] = i;
    levels = std::max(levels, requests[i].interval.last + 1);
  }
  const auto before = [&](uint32_t a, uint32_t b) {
    const AliasRequest &x = requests[a], &y = requests[b];
    if (x.need.bytes != y.need.bytes) return x.need.bytes > y.need.bytes;
    if (x.interval.first != y.interval.first) return x.interval.first < y.interval.first;
    return x.resource < y.resource;
  };
  // Images of one size, which most are, already come in this order.
  if (!std::is_sorted(order.begin(), order.end(), before)) std::sort(order.begin(), order.end(), before);
  uint32_t h = 0;
  for (uint32_t i = 0; i < requests.size(); ++i) {  // heaps in the order of appearance
    const uint32_t types = requests[i].need.memoryTypeBits;
    if (i == 0 || types != requests[i - 1].need.memoryTypeBits) {
      for (h = 0; h < result.heaps.size() && result.heaps[h].memoryTypeBits != types;) ++h;
      if (h == result.heaps.size()) {
        result.heaps.push_back({0, types});
        heaps.emplace_back(scratch, alias ? levels : 1);
      }
    }
    result.placements[i].heap = h;
  }
  const Interval always{0, 0};
  for (const uint32_t i : order) {
    const AliasRequest& request = requests[i];
    Placement& placement = result.placements[i];
    const uint64_t alignment = std::max<uint64_t>({request.need.alignment, granularity, 1});
    const uint64_t bytes = Occupancy::alignUp(std::max<uint64_t>(request.need.bytes, 1), alignment);
    const Interval& interval = alias ? request.interval : always;
    Occupancy& heap = heaps[placement.heap];
    placement.resource = request.resource;
    placement.bytes = bytes;
    placement.offset = heap.findGap(interval, bytes, alignment);
    heap.take(interval, {placement.offset, placement.offset + bytes});
    uint64_t& size = result.heaps[placement.heap].bytes;
    size = std::max(size, placement.offset + bytes);
    result.bytesUnaliased += bytes;
  }
  for (const Plan::Heap& heap : result.heaps) result.bytesAliased += heap.bytes;
  return result;
}

}  // namespace fovea::graph
