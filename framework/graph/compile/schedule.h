// Schedule: which passes run, and in which level each of them.
#pragma once

#include <optional>
#include <vector>

#include "framework/graph/compile/plan.h"

namespace fovea::graph {

struct Schedule {
  std::vector<uint8_t> passLive, resourceLive;
  std::vector<uint32_t> level;       // per pass; kNone when culled
  std::vector<uint32_t> order;       // live passes level by level, declaration order within a level
  std::vector<uint32_t> levelFirst;  // into `order`, one past the last level at the end
  uint32_t levels() const { return static_cast<uint32_t>(levelFirst.size()) - 1; }
};

// Culls backwards from the graph's outputs, passes with side effects and writes to the caller's memory,
// through history edges too; a kept resource that is touched keeps all its writers, because the next frame
// sees what they leave. Then each pass takes the earliest level after the producers of what it reads and
// after all readers of what it overwrites. With `randomOrder` any legal levels, by this seed.
Schedule schedule(const BoundGraph& graph, std::optional<uint32_t> randomOrder = std::nullopt);

// First and last level at which each live resource is touched; outputs last to the end of the frame
// (levels()).
struct Interval {
  uint32_t first = kNone, last = 0;
};
std::vector<Interval> lifetimes(const BoundGraph& graph, const Schedule& schedule);

// Transient resources share memory; kept ones, history, and the caller's never do.
inline bool isTransient(const BoundResource& r) {
  return r.lifetime == Lifetime::Transient && !r.external && !r.history;
}

}  // namespace fovea::graph
